use super::*;

#[test]
fn what_is_stored_comes_back() {
    let taps = |count: usize| Shared {
        taps: (0..count)
            .map(|k| Tap { place: k as f64 - 1.5, level: 2.0 + k as f64, spread: 0.5 * k as f64 })
            .collect(),
        shares: [0.1, 0.05].map(|step| (0..count).map(|k| step * (k + 1) as f64).collect()),
        parts: [-0.3, 0.7],
    };
    let sets = TAPS.map(taps);
    let mut values = vec![0; COLUMNS * ROWS * TILES * CHANNELS];
    let (row, column) = (7, 3);
    for tile in 0..TILES {
        let start = ((tile * ROWS + row) * COLUMNS + column) * CHANNELS;
        values[start..start + CHANNELS].copy_from_slice(&texel(tile, &sets).map(unorm16));
    }
    for (got, expected) in stored(&values, row, column).iter().zip(&sets) {
        let (got, expected) = (variables_of(got), variables_of(expected));
        assert!(got.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-4), "{got:?} {expected:?}");
    }
}

#[test]
fn shares_leave_the_mean_no_less_than_nothing() {
    let values = TABLE.values();
    for (row, column) in (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        for set in stored(&values, row, column) {
            // Shares of 16 bits are rounded.
            let sum = |shares: &Vec<f64>| shares.iter().sum::<f64>();
            assert!(set.shares.iter().all(|shares| sum(shares) < 1.0 + 3e-5), "{row} {column} {set:?}");
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
            assert!((tap.level - level_of_row(row as f64)).abs() < 1e-4, "{row} {column} {tap:?}");
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
    let (row, column) = (20, 10);
    let level = level_of_row(row as f64);
    let lobe = fit::lobe_at(&kernels, level, nov_of_column(column as f64));
    let mirror = Tap { place: 0.0, level, spread: 0.0 };
    let plain = Shared { taps: vec![mirror], shares: [vec![1.0], vec![1.0]], parts: [0.0; 2] };
    let sets = stored(&TABLE.values(), row, column);
    let costs = [&plain, &sets[0], &sets[1], &sets[2]].map(|set| lobe.cost_and_gradient(set).0);
    assert!(costs.is_sorted_by(|a, b| a > b), "{costs:?}");
}

#[test]
fn gradients_are_those_of_the_cost() {
    let kernels = Kernels::new();
    let lobe = fit::lobe_at(&kernels, 5.3, 0.3);
    let variables = [0.3, 5.2, 0.4, -0.8, 4.4, -0.3, 0.5, 0.3, 0.35, 0.4, 0.2, -0.1];
    let cost = |variables: &[f64]| lobe.cost_and_gradient(&Shared::from_variables(variables));
    for (k, by) in cost(&variables).1.into_iter().enumerate() {
        let moved = |step: f64| {
            let mut variables = variables;
            variables[k] += step;
            cost(&variables).0
        };
        let expected = (moved(1e-4) - moved(-1e-4)) / 2e-4;
        assert!((by - expected).abs() < 1e-6, "variable {k}: {by}, expected {expected}");
    }
}
