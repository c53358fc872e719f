use super::*;

#[test]
fn what_is_stored_comes_back() {
    let taps = |count: usize| Shared {
        taps: (0..count)
            .map(|k| Tap { place: k as f64 - 1.5, level: 2.0 + k as f64, spread: 0.5 * k as f64 })
            .collect(),
        weights: [0.1, 0.05].map(|step| (0..count + 2).map(|k| step * (k + 1) as f64).collect()),
    };
    let sets = [taps(1), taps(2), taps(3)];
    let mut values = vec![0; COLUMNS * ROWS * TILES * CHANNELS];
    let (row, column) = (7, 3);
    for tile in 0..TILES {
        let start = ((tile * ROWS + row) * COLUMNS + column) * CHANNELS;
        values[start..start + CHANNELS].copy_from_slice(&texel(tile, &sets).map(unorm16));
    }
    for (got, expected) in stored(&values, row, column).iter().zip(&sets) {
        for (got, expected) in got.taps.iter().zip(&expected.taps) {
            let off = [got.place - expected.place, got.level - expected.level, got.spread - expected.spread];
            assert!(off.iter().all(|off| off.abs() < 1e-4), "{got:?} {expected:?}");
        }
        let weights = |set: &Shared| set.weights.concat();
        assert!(weights(got).iter().zip(weights(expected)).all(|(a, b)| (a - b).abs() < 1e-4), "{got:?}");
    }
}

#[test]
fn shares_leave_the_mean_no_less_than_nothing() {
    let values = TABLE.values();
    for (row, column) in (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        for set in stored(&values, row, column) {
            // Three shares of 16 bits are rounded.
            let sum = |weights: &Vec<f64>| weights[..set.taps.len()].iter().sum::<f64>();
            assert!(set.weights.iter().all(|weights| sum(weights) < 1.0 + 3e-5), "{row} {column} {set:?}");
        }
    }
}

#[test]
fn no_tap_of_a_rougher_lobe_reads_the_mirror_image() {
    let values = TABLE.values();
    for (row, column) in FITTED_ROWS.flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        for tap in stored(&values, row, column).iter().flat_map(|set| &set.taps) {
            assert!(tap.level > 1.0 - 1e-4, "{row} {column} {tap:?}");
        }
    }
}

#[test]
fn next_to_the_mirror_image_all_taps_share_its_level() {
    let values = TABLE.values();
    for (row, column) in (0..=FITTED_ROWS.start).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        for tap in stored(&values, row, column).iter().flat_map(|set| &set.taps) {
            assert!((tap.level - level_of_row(row)).abs() < 1e-4, "{row} {column} {tap:?}");
        }
    }
}

#[test]
fn no_search_finds_much_better_taps_than_the_embedded() {
    assert_eq!(check(&TABLE), Ok(()), "run `specula bake taps.bin`");
}

#[test]
fn more_taps_leave_less_of_a_lobe() {
    let kernels = Kernels::new();
    let level = 5.0;
    let lobe = Lobe::new(&kernels, EnvironmentMaps::perceptual_roughness_at(level), 0.4);
    let row = (4.0 * level) as usize;
    let mirror = Tap { place: 0.0, level, spread: 0.0 };
    let plain = lobe.with_weights(&[mirror], &[vec![1.0, 0.0, 0.0], vec![1.0, 0.0, 0.0]]).cost();
    let [_, two, three] = stored(&TABLE.values(), row, 8);
    let costs = [&two, &three].map(|set| lobe.with_weights(&set.taps, &set.weights).cost());
    assert!(costs[1] <= costs[0] && costs[0] < plain, "{costs:?} {plain}");
}
