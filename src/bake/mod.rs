//! What is computed once and read while shading: tables from the float64 reference, maps from an environment.

pub mod dfg;
pub mod disney;
pub mod environment;
pub mod fresnel_tail;
mod harmonics;
mod irradiance;
mod lobe;
mod octahedral;
mod panorama;
pub mod studio;
pub mod sun;
mod table;
pub mod taps;
#[cfg(test)]
mod test_support;

pub use table::EmbeddedTable;

/// Every table that is part of the library.
pub const TABLES: [EmbeddedTable; 4] = [dfg::TABLE, fresnel_tail::TABLE, disney::TABLE, taps::TABLE];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_embedded_tables_are_what_a_bake_writes() {
        let folder = tempfile::tempdir().unwrap();
        // The Disney table takes longer and has a test of its own.
        for table in [dfg::TABLE, fresnel_tail::TABLE] {
            assert_eq!((table.check)(&table), Ok(()), "run `specula bake`");
            table.write(folder.path()).unwrap();
            let written = std::fs::read(folder.path().join(table.file)).unwrap();
            assert_eq!(written.len(), table.bytes.len(), "{}", table.file);
        }
    }
}
