//! Damaged copies of good files: whatever comes of them, it is a scene or an error, and never a panic.

use super::builder::load;
use super::hostile::{assert_clean, model};

/// xorshift64* (Vigna 2016): the same numbers everywhere, for ever.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }
}

fn flip_bytes(file: &mut [u8], random: &mut Random) {
    for _ in 0..1 + random.below(4) {
        let at = random.below(file.len());
        file[at] ^= 1 << random.below(8);
    }
}

fn cut(file: &mut Vec<u8>, random: &mut Random) {
    let length = random.below(file.len());
    file.truncate(length);
}

/// Replaces a number of the JSON by another of as many digits, so that the container stays whole.
fn edit_number(file: &mut [u8], random: &mut Random) {
    let json = if file.starts_with(b"glTF") {
        20..20 + u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize
    } else {
        0..file.len()
    };
    let starts: Vec<usize> =
        json.filter(|&at| file[at].is_ascii_digit() && matches!(file[at - 1], b':' | b'[' | b',')).collect();
    let at = starts[random.below(starts.len())];
    let end = (at..file.len()).find(|&at| !file[at].is_ascii_digit()).unwrap_or(file.len());
    let (first, rest) = file[at..end].split_first_mut().unwrap();
    *first = b'1' + random.below(9) as u8;
    rest.iter_mut().for_each(|digit| *digit = b'0' + random.below(10) as u8);
}

/// Writes bytes that are special as lengths, indices and floats.
fn plant_extremes(file: &mut [u8], random: &mut Random) {
    let words = [0, 1, u32::MAX, 0x7F80_0000, 0xFF80_0000, 0x7FC0_0000, 0x7F7F_FFFF, 0x8000_0000];
    let at = random.below(file.len() - 4) & !3;
    file[at..at + 4].copy_from_slice(&u32::to_le_bytes(words[random.below(words.len())]));
}

#[test]
fn mutants_never_panic() {
    let (mut accepted, mut refused) = (0, 0);
    for (seed, good) in [(1, model().glb()), (2, model().gltf())] {
        load(&good).unwrap();
        let mut random = Random(seed);
        for mutant in 0..1500 {
            let mut file = good.clone();
            match mutant % 5 {
                0 => flip_bytes(&mut file, &mut random),
                1 => cut(&mut file, &mut random),
                2 => plant_extremes(&mut file, &mut random),
                _ => edit_number(&mut file, &mut random),
            }
            match load(&file) {
                Ok(_) => accepted += 1,
                Err(error) => {
                    assert_clean(&format!("seed {seed}, mutant {mutant}"), &error, "model");
                    refused += 1;
                }
            }
        }
    }
    // Measured: 406 accepted, 2594 refused. Half of each.
    assert!(accepted > 200 && refused > 1300, "the mutants are too tame or too wild: {accepted}, {refused}");
}
