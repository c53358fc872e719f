//! Somebody else's engine: flat boxes by its own shader, in its own pass, with its own depth buffer.
#![allow(dead_code, reason = "each example and test uses another part")]

use specula::glam::{DMat4, DVec3, Mat4, UVec2, Vec3};
use specula::gpu::Gpu;
use specula::gpu::pipeline::DepthTarget;
use specula::gpu::{Readback, read_texture};
use specula::renderer::PassFormat;
use specula::scene::{Camera, Projection};
use specula::wgpu;
use wgpu::util::DeviceExt;

const SHADER: &str = "
struct Out { @builtin(position) place: vec4f, @location(0) color: vec3f }
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;
@vertex fn vertex(@location(0) position: vec3f, @location(1) color: vec3f) -> Out {
    return Out(clip_from_world * vec4f(position, 1.0), color);
}
@fragment fn fragment(in: Out) -> @location(0) vec4f { return vec4f(in.color, 1.0); }
";

/// A box of one colour, in linear light, around a point of the world.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Block {
    pub(crate) center: Vec3,
    pub(crate) half: Vec3,
    pub(crate) color: Vec3,
}

impl Block {
    /// Corners, and triangles of them, counterclockwise from outside.
    pub(crate) fn triangles(&self) -> (Vec<Vec3>, Vec<u32>) {
        let sign = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let corner = |i: u32| self.center + self.half * Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2));
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let indices = quads.iter().flat_map(|&[a, b, c, d]: &[u32; 4]| [a, b, c, a, c, d]).collect();
        ((0..8).map(corner).collect(), indices)
    }
}

/// The engine, for one kind of pass.
#[derive(Debug)]
pub(crate) struct Host {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    camera: wgpu::Buffer,
    vertices: wgpu::Buffer,
    count: u32,
}

impl Host {
    pub(crate) fn new(device: &wgpu::Device, pass: &PassFormat, blocks: &[Block]) -> Self {
        let corners = |block: &Block| -> Vec<[Vec3; 2]> {
            let (corners, indices) = block.triangles();
            indices.iter().map(|&index| [corners[index as usize], block.color]).collect()
        };
        let vertices: Vec<[Vec3; 2]> = blocks.iter().flat_map(corners).collect();
        let count = vertices.len() as u32;
        let vertices = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("host"),
            contents: bytemuck::cast_slice(&vertices),
            usage: wgpu::BufferUsages::VERTEX,
        });
        let camera = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("host"),
            size: 64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let pipeline = pipeline(device, pass);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("host"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: camera.as_entire_binding() }],
        });
        Self { pipeline, group, camera, vertices, count }
    }

    /// Where the next frame is seen from.
    pub(crate) fn look(&self, queue: &wgpu::Queue, clip_from_world: Mat4) {
        queue.write_buffer(&self.camera, 0, bytemuck::bytes_of(&clip_from_world));
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..self.count, 0..1);
    }
}

fn pipeline(device: &wgpu::Device, pass: &PassFormat) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(SHADER.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("host"), source });
    let depth = pass.depth.map(|depth| wgpu::DepthStencilState {
        format: depth.format,
        depth_write_enabled: Some(true),
        depth_compare: Some(if depth.reversed { wgpu::CompareFunction::Greater } else { wgpu::CompareFunction::Less }),
        stencil: Default::default(),
        bias: Default::default(),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("host"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 24,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
        depth_stencil: depth,
        multisample: wgpu::MultisampleState { count: pass.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: &[Some(pass.color.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The engine's own projection of a perspective camera, for its depth buffer.
pub(crate) fn clip_from_world(camera: &Camera, size_px: UVec2, pass: &PassFormat) -> Mat4 {
    let Projection::Perspective { fov_y_rad } = camera.projection else { return Mat4::IDENTITY };
    let (near, reversed) = (camera.near_m, pass.depth.is_none_or(|depth| depth.reversed));
    // Depth times the distance is a factor times the distance, plus a sum.
    let (factor, sum) = match pass.far_m {
        None => (1.0, -near),
        Some(far) => (far / (far - near), -near * far / (far - near)),
    };
    let (factor, sum) = if reversed { (1.0 - factor, -sum) } else { (factor, sum) };
    let f = 1.0 / (0.5 * fov_y_rad).tan();
    let aspect = f64::from(size_px.x) / f64::from(size_px.y);
    let clip_from_view = DMat4::from_cols_array_2d(&[
        [f / aspect, 0.0, 0.0, 0.0],
        [0.0, f, 0.0, 0.0],
        [0.0, 0.0, -factor, -1.0],
        [0.0, 0.0, sum, 0.0],
    ]);
    (clip_from_view * camera.world_from_view.inverse()).as_mat4()
}

/// Attachments of a pass.
#[derive(Debug)]
pub(crate) struct Attachments {
    pub(crate) color: wgpu::TextureView,
    pub(crate) resolve: Option<wgpu::TextureView>,
    pub(crate) depth: Option<wgpu::TextureView>,
}

impl Attachments {
    pub(crate) fn new(device: &wgpu::Device, pass: &PassFormat, size_px: UVec2) -> Self {
        let texture = |format, sample_count, usage| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("host"),
                size: wgpu::Extent3d { width: size_px.x, height: size_px.y, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let readable = attachment | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING;
        let many = pass.samples > 1;
        Self {
            color: texture(pass.color, pass.samples, if many { attachment } else { readable }),
            resolve: many.then(|| texture(pass.color, 1, readable)),
            depth: pass.depth.map(|depth| texture(depth.format, pass.samples, attachment)),
        }
    }

    /// Begins a pass that clears everything.
    pub(crate) fn begin<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        pass: &PassFormat,
        clear: wgpu::Color,
    ) -> wgpu::RenderPass<'e> {
        let depth = pass.depth.unwrap_or(DepthTarget::OWN);
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("host"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.color,
                depth_slice: None,
                resolve_target: self.resolve.as_ref(),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: self.depth.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(depth.farthest()),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: depth
                    .format
                    .has_stencil_aspect()
                    .then_some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }

    /// What the picture is read from.
    pub(crate) fn picture(&self) -> &wgpu::Texture {
        self.resolve.as_ref().unwrap_or(&self.color).texture()
    }
}

/// Submits what was recorded and reads the picture back: its bytes from the top left.
///
/// # Errors
/// Where the device fails.
pub(crate) fn read(
    gpu: &Gpu,
    mut encoder: wgpu::CommandEncoder,
    picture: &wgpu::Texture,
) -> Result<Vec<u8>, specula::gpu::GpuError> {
    let readback: Readback = read_texture(&gpu.device, &mut encoder, picture);
    gpu.queue.submit([encoder.finish()]);
    readback.wait(gpu)
}

/// Writes a picture of sRGB bytes as PNG.
///
/// # Errors
/// Where the file cannot be written.
pub(crate) fn save(name: &str, size_px: UVec2, rgba: &[u8]) -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| format!("docs/pictures/{name}.png"));
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
    image::save_buffer(path, &rgb, size_px.x, size_px.y, image::ColorType::Rgb8)?;
    Ok(())
}

/// A camera that looks at the origin.
pub(crate) fn camera_at(eye: DVec3, near_m: f64) -> Camera {
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, Projection::Perspective { fov_y_rad: 0.6 }, near_m, 100.0)
}
