//! Which settings are worth their time.

/// The indices of the points (time, error) that no other beats in one without being worse in the other, by time.
/// Points that are no numbers beat nothing and are never on the front.
pub(super) fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let beats = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1);
    let is_number = |point: &(f64, f64)| point.0.is_finite() && point.1.is_finite();
    let stands = |&i: &usize| is_number(&points[i]) && !points.iter().any(|other| beats(other, &points[i]));
    let mut front: Vec<usize> = (0..points.len()).filter(stands).collect();
    front.sort_by(|&a, &b| points[a].0.total_cmp(&points[b].0));
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nothing_beats_is_on_the_front() {
        let points = [(2.0, 1.0), (1.0, 4.0), (3.0, 1.0), (1.5, 4.0), (1.5, 2.0), (4.0, 0.5)];
        assert_eq!(front(&points), [1, 4, 0, 5]);
    }

    #[test]
    fn equal_points_share_the_front_and_numbers_that_are_none_stay_away() {
        assert_eq!(front(&[(1.0, 1.0), (1.0, 1.0)]), [0, 1]);
        assert_eq!(front(&[(f64::NAN, 0.0), (1.0, 1.0), (0.5, f64::NAN), (2.0, f64::INFINITY)]), [1]);
        assert_eq!(front(&[]), [0; 0]);
    }
}
