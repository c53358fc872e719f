//! Front to back, in linear time.

/// Depths are told apart in this many steps between the nearest and the farthest place of a drawable.
const STEPS: usize = 1024;

/// Fewer than this are sorted by comparison: counting has to visit every step.
const FEW: usize = 128;

/// Placements with the step of their depth. The order among those of one step is that of the scene, so that leaving
/// some out does not change how the others follow each other.
#[derive(Debug, Default)]
pub(super) struct DepthOrder {
    entries: Vec<(u16, u32)>,
}

impl DepthOrder {
    pub(super) fn clear(&mut self) {
        self.entries.clear();
    }

    pub(super) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Adds a placement whose depth is this fraction of the way from the nearest to the farthest.
    pub(super) fn push(&mut self, placement: u32, fraction: f32) {
        // A cast of what is out of range, or no number, ends at a border.
        let step = ((fraction * STEPS as f32) as usize).min(STEPS - 1);
        self.entries.push((step as u16, placement));
    }

    /// Appends `value` of every placement to `out`, nearest first.
    pub(super) fn append_sorted(&mut self, out: &mut Vec<u32>, value: impl Fn(u32) -> u32) {
        if self.entries.len() < FEW {
            self.entries.sort_unstable();
            out.extend(self.entries.iter().map(|&(_, placement)| value(placement)));
            return;
        }
        let mut next = [0_u32; STEPS];
        self.entries.iter().for_each(|&(step, _)| next[step as usize] += 1);
        let mut sum = out.len() as u32;
        for count in &mut next {
            (*count, sum) = (sum, sum + *count);
        }
        out.resize(out.len() + self.entries.len(), 0);
        for &(step, placement) in &self.entries {
            let place = &mut next[step as usize];
            out[*place as usize] = value(placement);
            *place += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counting_and_comparing_give_the_same_order() {
        let fraction = |i: u32| ((i * 7919 % 1009) as f32 / 1009.0 * 20.0).floor() / 20.0;
        for count in [0, 1, 5, 127, 128, 1000] {
            let mut order = DepthOrder::default();
            (0..count).for_each(|i| order.push(i, fraction(i)));
            let mut sorted = vec![42];
            order.append_sorted(&mut sorted, |placement| placement);
            let mut expected: Vec<u32> = (0..count).collect();
            expected.sort_by(|&a, &b| fraction(a).total_cmp(&fraction(b)));
            assert_eq!((sorted[0], &sorted[1..]), (42, &expected[..]));
        }
        let mut order = DepthOrder::default();
        [f32::NAN, f32::INFINITY, -1.0, 2.0].iter().zip(0..).for_each(|(&fraction, i)| order.push(i, fraction));
        let mut sorted = Vec::new();
        order.append_sorted(&mut sorted, |placement| placement);
        assert_eq!(sorted, [0, 2, 1, 3]);
    }
}
