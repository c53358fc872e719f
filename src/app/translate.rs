//! Events of the window, as ours.

use super::input::{Button, InputEvent, Modifiers, PIXELS_PER_LINE};
use glam::DVec2;
use winit::event::{ElementState, Ime, KeyEvent, MouseButton, MouseScrollDelta, Touch, TouchPhase, WindowEvent};
use winit::keyboard::Key;
use winit::platform::modifier_supplement::KeyEventExtModifierSupplement;

/// What users have done, if the event is of that kind.
pub(super) fn translate(event: &WindowEvent, fingers: &mut Fingers) -> Vec<InputEvent> {
    let one = |event| vec![event];
    match event {
        WindowEvent::CursorMoved { position, .. } => one(InputEvent::Pointer { x: position.x, y: position.y }),
        WindowEvent::CursorLeft { .. } => one(InputEvent::PointerLeft),
        WindowEvent::MouseInput { state, button, .. } => {
            let button = match button {
                MouseButton::Left => Button::Left,
                MouseButton::Middle => Button::Middle,
                MouseButton::Right => Button::Right,
                _ => return Vec::new(),
            };
            one(InputEvent::Button { button, pressed: *state == ElementState::Pressed })
        }
        WindowEvent::MouseWheel { delta, .. } => {
            let (x, y) = match delta {
                MouseScrollDelta::LineDelta(x, y) => (f64::from(*x), f64::from(*y)),
                MouseScrollDelta::PixelDelta(by) => (by.x / PIXELS_PER_LINE, by.y / PIXELS_PER_LINE),
            };
            one(InputEvent::Wheel { x, y })
        }
        WindowEvent::PinchGesture { delta, .. } if delta.is_finite() => {
            one(InputEvent::Pinch { factor: (1.0 + delta).max(0.1) })
        }
        WindowEvent::ModifiersChanged(modifiers) => {
            let held = modifiers.state();
            let (shift, alt) = (held.shift_key(), held.alt_key());
            one(InputEvent::Modifiers(Modifiers { shift, ctrl: held.control_key() || held.super_key(), alt }))
        }
        WindowEvent::KeyboardInput { event, is_synthetic: false, .. } => key(event).into_iter().collect(),
        WindowEvent::Ime(Ime::Commit(text)) => {
            one(InputEvent::Key { key: String::new(), pressed: true, text: Some(text.clone()) })
        }
        WindowEvent::DroppedFile(path) => one(InputEvent::Drop { path: path.clone() }),
        WindowEvent::Resized(size) => one(InputEvent::Resize { width: size.width, height: size.height }),
        WindowEvent::Touch(touch) => fingers.touched(touch),
        _ => Vec::new(),
    }
}

fn key(event: &KeyEvent) -> Option<InputEvent> {
    let key = match event.key_without_modifiers() {
        Key::Character(text) => text.to_uppercase(),
        Key::Named(named) => format!("{named:?}"),
        Key::Unidentified(_) | Key::Dead(_) => return None,
    };
    let text = event.text.as_ref().map(ToString::to_string);
    Some(InputEvent::Key { key, pressed: event.state == ElementState::Pressed, text })
}

/// Fingers on a screen, in the order in which they came. One is a mouse with its left button; two move the picture between
/// them, and scale it as they part.
#[derive(Debug, Default)]
pub(super) struct Fingers(Vec<(u64, DVec2)>);

impl Fingers {
    fn touched(&mut self, touch: &Touch) -> Vec<InputEvent> {
        let at_px = DVec2::new(touch.location.x, touch.location.y);
        let before = self.0.clone();
        match touch.phase {
            TouchPhase::Started => self.0.push((touch.id, at_px)),
            TouchPhase::Moved => self.0.iter_mut().filter(|(id, _)| *id == touch.id).for_each(|(_, at)| *at = at_px),
            TouchPhase::Ended | TouchPhase::Cancelled => self.0.retain(|(id, _)| *id != touch.id),
        }
        let pointer = |at: DVec2| InputEvent::Pointer { x: at.x, y: at.y };
        let button = |button, pressed| InputEvent::Button { button, pressed };
        match (before.as_slice(), self.0.as_slice()) {
            ([], [(_, at)]) => vec![pointer(*at), button(Button::Left, true)],
            ([_], [(_, at)]) => vec![pointer(*at)],
            ([_], []) => vec![pointer(at_px), button(Button::Left, false), InputEvent::PointerLeft],
            ([_], [(_, a), (_, b)]) => {
                vec![button(Button::Left, false), pointer(0.5 * (*a + *b)), button(Button::Middle, true)]
            }
            ([(_, a), (_, b)], [(_, c), (_, d)]) => {
                let factor = (c.distance(*d) / a.distance(*b).max(1.0)).clamp(0.1, 10.0);
                vec![pointer(0.5 * (*c + *d)), InputEvent::Pinch { factor }]
            }
            // The one that is left goes on as a mouse.
            ([_, _], [(_, at)]) => vec![button(Button::Middle, false), pointer(*at), button(Button::Left, true)],
            _ => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use winit::dpi::PhysicalPosition;
    use winit::event::DeviceId;

    #[test]
    fn two_fingers_move_and_scale() {
        let mut fingers = Fingers::default();
        let mut touch = |id, phase, x: f64, y: f64| {
            let location = PhysicalPosition::new(x, y);
            let touch = Touch { device_id: DeviceId::dummy(), phase, location, force: None, id };
            translate(&WindowEvent::Touch(touch), &mut fingers)
        };
        let pointer = |x, y| InputEvent::Pointer { x, y };
        let button = |button, pressed| InputEvent::Button { button, pressed };
        let (left, middle) = (Button::Left, Button::Middle);
        assert_eq!(touch(7, TouchPhase::Started, 100.0, 50.0), [pointer(100.0, 50.0), button(left, true)]);
        assert_eq!(touch(7, TouchPhase::Moved, 110.0, 50.0), [pointer(110.0, 50.0)]);
        let second = touch(8, TouchPhase::Started, 130.0, 50.0);
        assert_eq!(second, [button(left, false), pointer(120.0, 50.0), button(middle, true)]);
        let parted = touch(8, TouchPhase::Moved, 150.0, 50.0);
        assert_eq!(parted, [pointer(130.0, 50.0), InputEvent::Pinch { factor: 2.0 }]);
        let third = touch(9, TouchPhase::Started, 0.0, 0.0);
        assert_eq!((third, touch(9, TouchPhase::Ended, 0.0, 0.0)), (vec![], vec![]));
        let first_is_gone = touch(7, TouchPhase::Ended, 110.0, 50.0);
        assert_eq!(first_is_gone, [button(middle, false), pointer(150.0, 50.0), button(left, true)]);
        let last = touch(8, TouchPhase::Cancelled, 150.0, 60.0);
        assert_eq!(last, [pointer(150.0, 60.0), button(left, false), InputEvent::PointerLeft]);
    }
}
