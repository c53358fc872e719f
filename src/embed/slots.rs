//! Values by handles that know when theirs is gone.

/// Values in slots. A slot that is used again has another generation, so that an old handle finds nothing.
#[derive(Debug)]
pub(super) struct Slots<T> {
    slots: Vec<Slot<T>>,
}

#[derive(Debug)]
struct Slot<T> {
    generation: u32,
    value: Option<T>,
}

impl<T> Slots<T> {
    pub(super) fn new() -> Self {
        Self { slots: Vec::new() }
    }

    /// Index and generation of a place for `value`.
    pub(super) fn insert(&mut self, value: T) -> (u32, u32) {
        // A slot whose generations are used up stays empty.
        let is_free = |slot: &Slot<T>| slot.value.is_none() && slot.generation < u32::MAX;
        let index = self.slots.iter().position(is_free).unwrap_or(self.slots.len());
        if index == self.slots.len() {
            self.slots.push(Slot { generation: 0, value: None });
        }
        let slot = &mut self.slots[index];
        slot.value = Some(value);
        (index as u32, slot.generation)
    }

    pub(super) fn get(&self, (index, generation): (u32, u32)) -> Option<&T> {
        self.slots.get(index as usize).filter(|slot| slot.generation == generation)?.value.as_ref()
    }

    pub(super) fn remove(&mut self, (index, generation): (u32, u32)) -> Option<T> {
        let slot = self.slots.get_mut(index as usize).filter(|slot| slot.generation == generation)?;
        let value = slot.value.take()?;
        slot.generation = slot.generation.saturating_add(1);
        Some(value)
    }

    /// All values with their index and generation.
    pub(super) fn iter(&self) -> impl Iterator<Item = ((u32, u32), &T)> {
        (0..).zip(&self.slots).filter_map(|(index, slot)| Some(((index, slot.generation), slot.value.as_ref()?)))
    }

    pub(super) fn values_mut(&mut self) -> impl Iterator<Item = &mut T> {
        self.slots.iter_mut().filter_map(|slot| slot.value.as_mut())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn handles_of_what_is_gone_find_nothing() {
        let mut slots = Slots::new();
        let [a, b] = ["a", "b"].map(|value| slots.insert(value));
        assert_eq!([slots.remove(a), slots.remove(a)], [Some("a"), None]);
        let c = slots.insert("c");
        assert_eq!((c.0, slots.get(a), slots.get(b), slots.get(c)), (a.0, None, Some(&"b"), Some(&"c")));
        assert_eq!(slots.get((7, 0)), None);
        assert_eq!(slots.remove((7, 0)), None);
        slots.values_mut().for_each(|value| *value = "d");
        assert_eq!([slots.get(b), slots.get(c)], [Some(&"d"); 2]);
        assert!(slots.iter().eq([(c, &"d"), (b, &"d")]));
    }

    #[test]
    fn a_slot_without_generations_is_not_used_again() {
        let mut slots = Slots { slots: vec![Slot { generation: u32::MAX - 1, value: Some(0) }] };
        assert_eq!(slots.remove((0, u32::MAX - 1)), Some(0));
        assert_eq!(slots.insert(1), (1, 0));
    }
}
