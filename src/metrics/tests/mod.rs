//! Metrics against numbers of others, and against what must be so.

mod laws;
mod oracle;
mod pairs;
