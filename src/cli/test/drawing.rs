//! Pictures of cases, and what they are judged by.

use super::golden;
use super::ingredients::{BesideTruth, Finding, Gathering, Ingredients, channels, content_hash, size};
use super::report::Kind;
use super::suite::Case;
use crate::app::in_units;
use crate::capture::Wanted;
use crate::cli::error::CliError;
use crate::cli::shot::{Shot, ShotArgs};
use crate::cli::stage::{Stage, pixels};
use crate::cli::subject::SubjectArgs;
use crate::reference::EstimateOptions;
use crate::reference::color::to_srgb8;
use crate::reference::estimate;
use crate::scene::{Background, Channel, RadianceImage, View};
use glam::UVec2;
use std::path::Path;
use std::time::Instant;

/// The picture of a case.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) size_px: UVec2,
    /// sRGB with straight alpha.
    pub(super) rgba: Vec<u8>,
    /// [`golden::picture_hash`] of it.
    pub(super) picture_hash: String,
    /// Of a furnace, cd/m2.
    pub(super) radiance: Option<RadianceImage>,
    /// Where the radiance is no number or infinite, of which the display shows nothing: targets hold neither.
    pub(super) fault: Option<String>,
    /// Of the model, what it refers to, and the environment.
    pub(super) scene_hash: String,
    /// What the reference renderer makes of the same view, for a case that asks.
    pub(super) truth: Option<Vec<u8>>,
    /// Most pixels by which a repetition differs.
    pub(super) differing_when_repeated: Option<usize>,
    pub(super) load_ms: f64,
    pub(super) draw_ms: f64,
}

impl<'a> Stage<'a> {
    /// The picture of a case, drawn `times` times from the upload on. If it is not the `known` one, by its hash, its
    /// radiance is searched for faults.
    ///
    /// # Errors
    /// When the model or the environment cannot be read, or the device fails.
    pub(super) fn draw(&mut self, case: &'a Case, times: u32, known: Option<&str>) -> Result<Drawn, CliError> {
        let start = Instant::now();
        let shot = case.args.shot();
        self.load(shot.subject)?;
        let view = self.view(shot, None)?;
        let scene = self.upload(shot, &view)?;
        let load_ms = milliseconds(start);
        let start = Instant::now();
        let wanted =
            Wanted { radiance: case.kind == Kind::Furnace || view.channel.is_some(), display: view.channel.is_none() };
        let (rgba, radiance) = pixels(self.frame(shot, &view, scene, wanted)?, &view);
        let draw_ms = milliseconds(start);
        let size_px = view.size_px;
        let picture_hash = golden::picture_hash(size_px.x, size_px.y, &rgba);
        let fault = if known == Some(&picture_hash) { None } else { self.fault(shot, &view, scene)? };
        let mut differing_when_repeated = (times > 1).then_some(0);
        for _ in 1..times {
            let again = self.draw_anew(shot, &view, wanted, &rgba)?;
            differing_when_repeated = differing_when_repeated.max(Some(again));
        }
        let truth = (case.kind == Kind::Reference).then(|| self.trace(&case.args, &view)).transpose()?;
        let scene_hash = self.scene_hash()?.to_owned();
        Ok(Drawn {
            size_px,
            rgba,
            picture_hash,
            radiance,
            fault,
            scene_hash,
            truth,
            differing_when_repeated,
            load_ms,
            draw_ms,
        })
    }

    /// What the picture of a case is made of, from views that are no larger than that needs.
    ///
    /// # Errors
    /// As [`Self::draw`].
    pub(super) fn ingredients(&mut self, case: &'a Case) -> Result<Ingredients, CliError> {
        self.load(&case.args.subject)?;
        // Edges are not measured, and four samples take three times as long. A fault may be in one of them alone.
        let frame = case.args.frame.with_one_sample();
        let shot = Shot { frame: &frame, ..case.args.shot() };
        let picture = self.view(shot, None)?;
        let view = measured(&picture, size(picture.size_px));
        let place = self.upload(shot, &view)?;
        let surroundings = self.surroundings(&case.args.subject)?;
        let scale = f64::from(picture.size_px.x) / f64::from(view.size_px.x);
        let mut gathering = Gathering::new(self.scene()?, &view, scale, &surroundings);
        for (name, channel) in channels(self.scene()?, case.kind == Kind::Furnace) {
            let shot = if channel == Channel::Nan { case.args.shot() } else { shot };
            let view = View { channel: Some(channel), ..view.clone() };
            let frame = self.frame(shot, &view, place, Wanted { radiance: true, display: false })?;
            if let Some(radiance) = frame.radiance {
                gathering.take(&name, &in_units(channel, radiance, &view));
            }
        }
        Ok(gathering.finish())
    }

    /// What of the picture of a reference case is not the truth, part by part of its light.
    ///
    /// # Errors
    /// As [`Self::draw`].
    pub(super) fn beside_truth(&mut self, case: &'a Case) -> Result<Vec<Finding>, CliError> {
        let frame = case.args.frame.with_one_sample();
        self.load(&case.args.subject)?;
        let shot = Shot { frame: &frame, ..case.args.shot() };
        let picture = self.view(shot, None)?;
        let view = measured(&picture, BesideTruth::size(picture.size_px));
        let place = self.upload(shot, &view)?;
        let asked = case.args.truth.options(self.progress);
        let options = EstimateOptions { bounces: 0, ..BesideTruth::options(asked) };
        let mut beside = BesideTruth::new(self.scene()?, &view);
        let terms: Vec<_> = BesideTruth::terms(self.scene()?).collect();
        for term in terms {
            let view = View { term: Some(term), ..view.clone() };
            let drawn = self.frame(shot, &view, place, Wanted { radiance: true, display: false })?;
            if let Some(drawn) = drawn.radiance {
                beside.take(term, &drawn, &estimate(self.scene()?, &view, &options));
            }
        }
        if asked.bounces > 0 {
            let with = EstimateOptions { bounces: asked.bounces, ..options };
            let [without, with] =
                [options, with].map(|options| self.scene().map(|scene| estimate(scene, &view, &options)));
            beside.take_bounces(&without?, &with?, asked.bounces);
        }
        Ok(beside.findings())
    }

    /// The environment by name and, of a file, by content.
    fn surroundings(&mut self, args: &SubjectArgs) -> Result<String, CliError> {
        let name = args.environment_name().to_owned();
        if !args.has_panorama() {
            return Ok(name);
        }
        let hash = self.hash_of_file(Path::new(args.environment_source()))?;
        Ok(format!("{name} ({})", content_hash(&hash)))
    }

    /// Shades once more, to find out where the radiance is no number before it is clamped.
    fn fault(&mut self, shot: Shot<'_>, view: &View, scene: usize) -> Result<Option<String>, CliError> {
        let view = View { channel: Some(Channel::Nan), background: Background::Transparent, ..view.clone() };
        let frame = self.frame(shot, &view, scene, Wanted { radiance: true, display: false })?;
        Ok(frame.radiance.as_ref().and_then(golden::fault))
    }

    /// Uploads and draws once more; returns how many pixels differ.
    fn draw_anew(&mut self, shot: Shot<'_>, view: &View, wanted: Wanted, rgba: &[u8]) -> Result<usize, CliError> {
        self.forget_uploads();
        let scene = self.upload(shot, view)?;
        let (again, _) = pixels(self.frame(shot, view, scene, wanted)?, view);
        Ok(rgba.chunks_exact(4).zip(again.chunks_exact(4)).filter(|(a, b)| a != b).count())
    }

    fn trace(&self, args: &ShotArgs, view: &View) -> Result<Vec<u8>, CliError> {
        let truth = estimate(self.scene()?, view, &args.truth.options(self.progress));
        Ok(to_srgb8(&truth.radiance, view))
    }
}

/// The view of a picture without what is behind the surfaces, of another size.
fn measured(picture: &View, size_px: UVec2) -> View {
    View { size_px, background: Background::Transparent, channel: None, ..picture.clone() }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
