//! The recipes of docs/sharding.md, followed as they stand there.

use super::slurm::Slurm;
use super::{suite, timeless, whole};
use crate::cli::stderr;
use crate::support::program;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// The text between the marker of a recipe and the end of its block of code.
fn recipe(name: &str, language: &str) -> String {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/sharding.md")).unwrap();
    let (_, rest) = text.split_once(&format!("<!-- {name} -->\n```{language}\n")).expect("the recipe is there");
    rest.split_once("```").expect("the recipe ends").0.to_owned()
}

/// A scheduler, and the recipe that is for it.
pub(super) enum Scheduler {
    Parallel,
    Slurm(Slurm),
}

impl Scheduler {
    /// `None` where it is not installed; that is said.
    pub(super) fn parallel() -> Option<Self> {
        let version = Command::new("parallel").arg("--version").output().ok();
        let is_there = version.is_some_and(|output| output.stdout.starts_with(b"GNU parallel"));
        is_there.then_some(Self::Parallel).or_else(|| missing("GNU parallel; apt-get install parallel"))
    }

    /// The same.
    pub(super) fn slurm() -> Option<Self> {
        Slurm::start().map(Self::Slurm).or_else(|| missing("Slurm; apt-get install slurm-wlm"))
    }

    /// Follows its recipe with so many parts instead of four, after some commands.
    pub(super) fn run(&self, folder: &Path, before: &str, parts: usize) -> Output {
        let (name, four) = match self {
            Self::Parallel => ("parallel", "parts=4"),
            Self::Slurm(_) => ("slurm", "--array=1-4"),
        };
        let recipe = recipe(name, "sh");
        assert!(recipe.contains(four), "{recipe}");
        let recipe = recipe.replace(four, &four.replace('4', &parts.to_string()));
        let mut shell = shell(folder, &format!("{before}\n{recipe}"));
        if let Self::Slurm(slurm) = self {
            shell.env("SLURM_CONF", slurm.configuration());
        }
        shell.output().unwrap()
    }
}

/// `scripts/test.sh` installs it under CI=true where it may.
fn missing<T>(what: &str) -> Option<T> {
    println!("skipped: no {what}");
    None
}

/// A shell in the folder, with the program on the path.
fn shell(folder: &Path, commands: &str) -> Command {
    let program = program();
    let own = Path::new(program.get_program()).parent().unwrap().to_owned();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut shell = Command::new("sh");
    shell.env("PATH", std::env::join_paths([own].into_iter().chain(std::env::split_paths(&path))).unwrap());
    shell.envs(program.get_envs().filter_map(|(name, value)| Some((name, value?))));
    for variable in ["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "CI_NODE_INDEX"] {
        shell.env_remove(variable);
    }
    shell.current_dir(folder).env("HOME", folder).args(["-ec", commands]);
    shell
}

/// Whether the report that the recipe has left is that of one process; then it goes, with the parts.
fn check(folder: &Path, output: &Output, (whole, parts): (&Value, usize)) {
    assert_eq!(output.status.code(), Some(1), "the furnace fails: {}", stderr(output));
    assert_eq!(std::fs::read_dir(folder.join("parts")).unwrap().count(), parts);
    assert_eq!(timeless(&folder.join("report")), *whole, "{parts} parts");
    for name in ["report", "parts"] {
        std::fs::remove_dir_all(folder.join(name)).unwrap();
    }
}

fn follow(scheduler: Option<Scheduler>) {
    let Some(scheduler) = scheduler else { return };
    let suite = suite();
    let whole = whole(suite.path());
    for parts in [1, 2, 4] {
        let output = scheduler.run(suite.path(), "", parts);
        check(suite.path(), &output, (&whole, parts));
    }
}

#[test]
fn the_recipe_for_gnu_parallel_works() {
    follow(Scheduler::parallel());
}

#[test]
fn the_recipe_for_slurm_works() {
    follow(Scheduler::slurm());
}

/// What a recipe in YAML runs: the rest of the lines that begin with `marker`, without quotes around it.
fn commands(recipe: &str, marker: &str) -> Vec<String> {
    let after = recipe.lines().filter_map(|line| line.trim_start().strip_prefix(marker));
    after.map(|command| command.trim().trim_matches(['\'', '[', ']']).to_owned()).collect()
}

/// Runs one command for each part, all at the same time, each with its own number in a variable.
fn run_parts(folder: &Path, command: &str, variables: impl Fn(usize) -> [(&'static str, String); 2]) {
    let children: Vec<_> = (0..4)
        .map(|part| shell(folder, command).envs(variables(part)).stdout(Stdio::null()).spawn().unwrap())
        .collect();
    for mut child in children {
        // One of the parts has the furnace.
        assert!(matches!(child.wait().unwrap().code(), Some(0 | 1)), "{command}");
    }
}

#[test]
fn the_recipe_for_kubernetes_works_without_kubernetes() {
    let suite = suite();
    let folder = suite.path();
    let whole = whole(folder);
    let job = recipe("kubernetes", "yaml");
    let [command] = &commands(&job, "args: ")[..] else { panic!("one command in {job}") };
    for line in ["completionMode: Indexed", "completions: 4", "{ name: JOB_COMPLETIONS, value: \"4\" }"] {
        assert!(job.contains(line), "{line}");
    }
    // The volume of all pods is the folder.
    let here = |text: &str| text.replace("/out/", "");
    run_parts(folder, &here(command), |part| {
        [("JOB_COMPLETION_INDEX", part.to_string()), ("JOB_COMPLETIONS", "4".into())]
    });
    let output = shell(folder, &here(&recipe("kubernetes-merge", "sh"))).output().unwrap();
    check(folder, &output, (&whole, 4));
}

#[test]
fn the_recipe_for_gitlab_works_without_gitlab() {
    let suite = suite();
    let folder = suite.path();
    let whole = whole(folder);
    let text = recipe("gitlab", "yaml");
    let [part, merge] = &commands(&text, "- specula ")[..] else { panic!("two commands in {text}") };
    assert!(text.contains("parallel: 4"), "{text}");
    run_parts(folder, &format!("specula {part}"), |part| {
        [("CI_NODE_INDEX", (part + 1).to_string()), ("CI_NODE_TOTAL", "4".into())]
    });
    let output = shell(folder, &format!("specula {merge}")).output().unwrap();
    check(folder, &output, (&whole, 4));
}

/// The runner's own commands are `uses`; of these the artifacts are carried from checkout to checkout here.
#[test]
fn the_recipe_for_github_works_without_github() {
    let suite = suite();
    let folder = suite.path();
    let whole = whole(folder);
    let text = recipe("github", "yaml");
    let steps = commands(&text, "- run: ");
    let [install, build, part, build_again, merge] = &steps[..] else { panic!("five steps in {text}") };
    assert!(install.ends_with("apt-get install --yes mesa-vulkan-drivers") && build == build_again, "{steps:?}");
    let [name, path] = ["name: part-", "path: parts/"].map(|key| format!("{key}${{{{ matrix.part }}}}"));
    assert!(text.contains("part: [1, 2, 3, 4]") && text.contains(&name) && text.contains(&path), "{text}");
    for number in ["1", "2", "3", "4"] {
        let command = part.replace("${{ matrix.part }}", number).replace("${{ strategy.job-total }}", "4");
        assert!(!command.contains("${{"), "{command}");
        let output = shell(folder, &command).output().unwrap();
        assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
        // Every artifact is a folder of its name.
        std::fs::create_dir_all(folder.join("downloaded")).unwrap();
        let [from, to] = [format!("parts/{number}"), format!("downloaded/part-{number}")];
        std::fs::rename(folder.join(from), folder.join(to)).unwrap();
    }
    std::fs::remove_dir(folder.join("parts")).unwrap();
    std::fs::rename(folder.join("downloaded"), folder.join("parts")).unwrap();
    let output = shell(folder, merge).output().unwrap();
    assert!(String::from_utf8_lossy(&output.stdout).contains("::error file=suite.toml"), "{output:?}");
    check(folder, &output, (&whole, 4));
}
