//! Events of the window, as ours.

use super::input::{Button, InputEvent, Modifiers};
use winit::event::{ElementState, Ime, KeyEvent, MouseButton, MouseScrollDelta, TouchPhase, WindowEvent};
use winit::keyboard::Key;
use winit::platform::modifier_supplement::KeyEventExtModifierSupplement;

/// Pixels that a touch pad scrolls for a line of a wheel.
const PIXELS_PER_LINE: f64 = 40.0;

/// What users have done, if the event is of that kind.
pub(super) fn translate(event: &WindowEvent) -> Vec<InputEvent> {
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
        // One finger is a mouse with a button.
        WindowEvent::Touch(touch) => {
            let pointer = InputEvent::Pointer { x: touch.location.x, y: touch.location.y };
            let button = |pressed| InputEvent::Button { button: Button::Left, pressed };
            match touch.phase {
                TouchPhase::Started => vec![pointer, button(true)],
                TouchPhase::Moved => vec![pointer],
                TouchPhase::Ended | TouchPhase::Cancelled => vec![pointer, button(false), InputEvent::PointerLeft],
            }
        }
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
