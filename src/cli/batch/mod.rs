//! Many pictures by one call and on one device: sequences of frames, and jobs of a manifest.

mod animation;
mod args;
mod keep;
mod manifest;
mod names;
mod report;

pub(super) use args::{BatchArgs, SUBJECT};

use super::driver::DriverArgs;
use super::environment::CacheArgs;
use super::error::CliError;
use super::output;
use super::progress::StderrProgress;
use super::shot::Shot;
use super::stage::{Stage, pixels};
use super::test::Share;
use crate::capture::Wanted;
use crate::gpu::formats::Precision;
use crate::gpu::{Gpu, GpuOptions};
use crate::progress::{Progress, Silent};
use animation::AnimationFormat;
use args::FrameRange;
use keep::Record;
use report::{BatchReport, PictureReport, PictureStatus};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What is asked for beside the pictures themselves.
pub(super) struct Batch<'a> {
    pub(super) args: &'a BatchArgs,
    /// Of the command line; a manifest has its own.
    pub(super) shot: Shot<'a>,
    pub(super) driver: &'a DriverArgs,
    pub(super) cache: &'a CacheArgs,
    /// The folder.
    pub(super) out: &'a Path,
    pub(super) json: bool,
    pub(super) quiet: bool,
}

/// One picture and where it goes.
struct Job<'a> {
    shot: Shot<'a>,
    /// How far the camera has turned, radians.
    turn_rad: Option<f64>,
    path: PathBuf,
    /// Unique in the run.
    name: String,
}

impl Batch<'_> {
    /// Draws all pictures, and what is made of them.
    ///
    /// # Errors
    /// When something is asked for that cannot be, there is no adapter, or a picture cannot be drawn.
    pub(super) fn run(&self) -> Result<(), CliError> {
        if self.driver.is_reference() {
            return Err(CliError::Usage(
                "many pictures are drawn by a GPU or a software driver; leave out --renderer".into(),
            ));
        }
        if self.out == Path::new("-") {
            return Err(CliError::Usage("many pictures go to a folder; -o has to name one".into()));
        }
        let lines = self.args.manifest.as_deref().map(manifest::read).transpose()?.unwrap_or_default();
        let all = match self.args.frames {
            Some(frames) => self.frames(frames)?,
            None => lines.iter().map(|line| self.line(line)).collect(),
        };
        let jobs = self.part(all)?;
        let folders: BTreeSet<&Path> = jobs.iter().filter_map(|job| job.path.parent()).collect();
        folders.into_iter().for_each(output::clear_stale);
        let mut report = self.draw_all(&jobs)?;
        if report.failure().is_none() {
            report.made = self.make_of_frames(&jobs)?;
        }
        if self.json {
            output::write(Path::new("-"), report.json()?.as_bytes())?;
        } else if !self.quiet {
            eprintln!("specula: {}", report.summary(self.out));
        }
        report.failure().map_or(Ok(()), |failure| Err(CliError::Usage(failure)))
    }

    fn frames(&self, range: FrameRange) -> Result<Vec<Job<'_>>, CliError> {
        let model = self.shot.subject.model();
        if model == Path::new("-") {
            return Err(CliError::Usage("a sequence reads its model from a file, not from stdin".into()));
        }
        for path in &self.args.animation {
            AnimationFormat::of(path).map_err(CliError::Usage)?;
        }
        let degrees = self.args.turn.unwrap_or(360.0 / f64::from(range.end));
        let default = names::NamePattern::default();
        let pattern = self.args.frame_name.as_ref().unwrap_or(&default);
        let stem = model.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
        let view = self.shot.view.camera_name();
        let job = |frame: u32| {
            let name = pattern.name(&stem, view, frame);
            let path = self.out.join(format!("{name}.png"));
            Job { shot: self.shot, turn_rad: Some((degrees * f64::from(frame)).to_radians()), path, name }
        };
        Ok((range.first..range.end).map(job).collect())
    }

    fn line<'a>(&self, line: &'a manifest::ManifestJob) -> Job<'a> {
        Job { shot: line.args.shot(), turn_rad: None, path: manifest::place(self.out, line), name: line.output.clone() }
    }

    /// Those of the pictures that this process draws.
    fn part<'a>(&self, jobs: Vec<Job<'a>>) -> Result<Vec<Job<'a>>, CliError> {
        let Some(request) = self.args.partition else { return Ok(jobs) };
        if request.is_by_weight() {
            return Err(CliError::Usage("--partition weight is for `specula test`; take slice or hash".into()));
        }
        let partition = request.resolve_here()?;
        let shares: Vec<Share<'_>> = jobs.iter().map(|job| Share { id: &job.name, milliseconds: None }).collect();
        let chosen = partition.select(&shares);
        let jobs = jobs.into_iter().enumerate();
        Ok(jobs.filter(|(index, _)| chosen.contains(index)).map(|(_, job)| job).collect())
    }

    fn draw_all(&self, jobs: &[Job<'_>]) -> Result<BatchReport, CliError> {
        let precisions = jobs.iter().map(|job| job.shot.frame.precision());
        let precision = precisions.max_by_key(|precision| *precision == Precision::Float).unwrap_or_default();
        let gpu = Gpu::open(&self.driver.request(), GpuOptions { precision }).map_err(CliError::NeedsAdapter)?;
        let progress = StderrProgress::new(self.quiet);
        progress.begin("Drawing pictures", jobs.len() as u64);
        let mut stage = Stage::new(&gpu, self.cache, &Silent);
        let mut pictures = Vec::new();
        for job in jobs {
            let start = Instant::now();
            let drawn = self.draw(&mut stage, &gpu, job);
            let milliseconds = start.elapsed().as_secs_f64() * 1e3;
            let (status, reason) = match drawn {
                Ok(status) => (status, None),
                Err(error) => (PictureStatus::Failed, Some(error.to_string())),
            };
            let has_failed = status == PictureStatus::Failed;
            pictures.push(PictureReport { output: job.path.clone(), status, reason, milliseconds });
            progress.advance(1);
            // The frames of a sequence would fail alike; jobs of a manifest have nothing to do with each other.
            if has_failed && self.args.frames.is_some() {
                break;
            }
        }
        progress.finish();
        Ok(BatchReport::new(&gpu, pictures))
    }

    fn draw<'a>(&self, stage: &mut Stage<'a>, gpu: &Gpu, job: &Job<'a>) -> Result<PictureStatus, CliError> {
        let shot = job.shot;
        stage.load(shot.subject)?;
        let view = stage.view(shot, job.turn_rad)?;
        let record = Record {
            version: env!("CARGO_PKG_VERSION").into(),
            model: shot.subject.model().display().to_string(),
            key: keep::key(&[
                env!("CARGO_PKG_VERSION"),
                &gpu.description(),
                stage.scene_hash()?,
                &shot.subject.settings(),
                &format!("{:?} {:?}", shot.frame, view),
            ]),
        };
        if self.args.resume && keep::is_done(&job.path, &record) {
            return Ok(PictureStatus::Kept);
        }
        let scene = stage.upload(shot, &view)?;
        let is_channel = view.channel.is_some();
        let frame = stage.frame(shot, &view, scene, Wanted { radiance: is_channel, display: !is_channel })?;
        let (rgba, _) = pixels(frame, &view);
        let png = keep::encode(view.size_px.x, view.size_px.y, &rgba, &record);
        let png = png.map_err(|reason| CliError::Write { path: job.path.clone(), reason })?;
        output::write_in_folders(&job.path, &png)?;
        Ok(PictureStatus::Drawn)
    }

    /// Animations and the contact sheet; returns their files.
    fn make_of_frames(&self, jobs: &[Job<'_>]) -> Result<Vec<PathBuf>, CliError> {
        let frames: Vec<&Path> = jobs.iter().map(|job| job.path.as_path()).collect();
        let rate = self.args.fps.unwrap_or(24.0);
        let mut made = Vec::new();
        for path in &self.args.animation {
            let format = AnimationFormat::of(path).map_err(CliError::Usage)?;
            let bytes = animation::animation(format, &frames, rate).map_err(CliError::Usage)?;
            output::write_in_folders(path, &bytes)?;
            made.push(path.clone());
        }
        if let Some(path) = &self.args.contact_sheet {
            let sheet = animation::contact_sheet(&frames).map_err(CliError::Usage)?;
            let png = output::png(sheet.width(), sheet.height(), sheet.as_raw());
            output::write_in_folders(path, &png.map_err(|reason| CliError::Write { path: path.clone(), reason })?)?;
            made.push(path.clone());
        }
        Ok(made)
    }
}
