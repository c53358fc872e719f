//! A Slurm of one node for a test alone: its two daemons, with ports and a folder of their own and nobody to authenticate.

use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Ended with the value.
pub(super) struct Slurm {
    folder: TempDir,
    daemons: Vec<Child>,
}

impl Slurm {
    /// `None` where Slurm is not installed.
    pub(super) fn start() -> Option<Self> {
        let has = |daemon: &str| Command::new(daemon).arg("-V").output().is_ok_and(|output| output.status.success());
        if !has("slurmctld") || !has("slurmd") {
            return None;
        }
        let mut slurm = Self { folder: tempfile::tempdir().unwrap(), daemons: Vec::new() };
        let file = |name: &str| slurm.folder.path().join(name);
        for name in ["state", "spool"] {
            std::fs::create_dir(file(name)).unwrap();
        }
        std::fs::write(slurm.configuration(), configuration(slurm.folder.path())).unwrap();
        for (daemon, more) in [("slurmctld", vec!["-D"]), ("slurmd", vec!["-D", "-N", "localhost"])] {
            let log = std::fs::File::create(slurm.folder.path().join(format!("{daemon}.out"))).unwrap();
            let mut command = Command::new(daemon);
            command.args(more).arg("-f").arg(slurm.configuration()).env("SLURM_CONF", slurm.configuration());
            command.stdout(Stdio::null()).stderr(log);
            slurm.daemons.push(command.spawn().unwrap());
        }
        slurm.wait_until_idle();
        Some(slurm)
    }

    /// What SLURM_CONF has to name.
    pub(super) fn configuration(&self) -> PathBuf {
        self.folder.path().join("slurm.conf")
    }

    fn wait_until_idle(&self) {
        let start = Instant::now();
        loop {
            let nodes =
                Command::new("sinfo").arg("--noheader").env("SLURM_CONF", self.configuration()).output().unwrap();
            if String::from_utf8_lossy(&nodes.stdout).contains("idle") {
                return;
            }
            let logs = ["slurmctld.out", "slurmd.out"].map(|name| self.folder.path().join(name));
            let logs = logs.map(|log| std::fs::read_to_string(log).unwrap_or_default());
            assert!(start.elapsed() < Duration::from_secs(60), "Slurm has no idle node: {logs:?}");
            std::thread::sleep(Duration::from_millis(200));
        }
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        for daemon in &mut self.daemons {
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

fn configuration(folder: &Path) -> String {
    let free = || TcpListener::bind("127.0.0.1:0").unwrap();
    // Both are held until both are known.
    let ports = [free(), free()];
    let [controller, node] = ports.each_ref().map(|port| port.local_addr().unwrap().port());
    let user = Command::new("id").arg("-un").output().unwrap();
    let user = String::from_utf8(user.stdout).unwrap();
    let (user, folder) = (user.trim(), folder.display());
    format!(
        "ClusterName=test\nSlurmctldHost=localhost\nSlurmctldPort={controller}\nSlurmdPort={node}\n\
         SlurmUser={user}\nSlurmdUser={user}\nAuthType=auth/none\nCredType=cred/none\n\
         StateSaveLocation={folder}/state\nSlurmdSpoolDir={folder}/spool\n\
         SlurmctldPidFile={folder}/slurmctld.pid\nSlurmdPidFile={folder}/slurmd.pid\n\
         ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres\n\
         SchedulerParameters=sched_interval=1,batch_sched_delay=0\nMailProg=/bin/true\nReturnToService=2\n\
         MpiDefault=none\nNodeName=localhost CPUs=2 RealMemory=1000 State=UNKNOWN\n\
         PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n"
    )
}
