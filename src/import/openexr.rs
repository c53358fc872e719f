//! OpenEXR layers and their colours, for panoramas and for pictures.

use super::error::Fault;
use super::limits::Limits;
use exr::error::Error;
use exr::image::{AnyChannels, FlatSamples, Layer};
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers};
use glam::Vec3;
use std::io::Cursor;

pub(super) type AnyLayer = Layer<AnyChannels<FlatSamples>>;

/// All flat layers. `check_size` refuses sizes before memory is allocated for them; `broken` words a decoder's error.
pub(super) fn layers(
    bytes: &[u8],
    check_size: impl Fn(usize, usize) -> Result<(), Fault>,
    broken: impl Fn(Error) -> Fault,
) -> Result<Vec<AnyLayer>, Fault> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(&broken)?;
    let mut samples = 0_u64;
    for header in &meta.headers {
        check_size(header.layer_size.width(), header.layer_size.height())?;
        let texels = (header.layer_size.width() * header.layer_size.height()) as u64;
        samples = samples.saturating_add(texels.saturating_mul(header.channels.list.len() as u64));
    }
    if samples.saturating_mul(4) > Limits::default().decoded_bytes {
        return Err(broken(Error::Invalid("its layers are larger than the limit on decoded bytes".into())));
    }
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(broken)?;
    Ok(image.layer_data.into_vec())
}

/// Width and height in texels.
pub(super) fn size(layer: &AnyLayer) -> Option<(u32, u32)> {
    Some((u32::try_from(layer.size.width()).ok()?, u32::try_from(layer.size.height()).ok()?))
}

/// A channel by the last part of its name; `None` if the layer has none at full resolution.
pub(super) fn channel(layer: &AnyLayer, wanted: &str) -> Option<Vec<f32>> {
    let is_wanted = |name: &str| name.rsplit('.').next() == Some(wanted);
    let channel = layer.channel_data.list.iter().find(|channel| is_wanted(&channel.name.to_string()))?;
    let values: Vec<f32> = channel.sample_data.values_as_f32().collect();
    (values.len() == layer.size.width() * layer.size.height()).then_some(values)
}

/// R, G and B, or Y three times; `None` if the layer has neither.
pub(super) fn colors(layer: &AnyLayer) -> Option<Vec<Vec3>> {
    match (channel(layer, "R"), channel(layer, "G"), channel(layer, "B")) {
        (Some(red), Some(green), Some(blue)) => {
            Some(red.into_iter().zip(green).zip(blue).map(|((r, g), b)| Vec3::new(r, g, b)).collect())
        }
        _ => Some(channel(layer, "Y")?.into_iter().map(Vec3::splat).collect()),
    }
}
