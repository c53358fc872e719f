//! The clock of the processors.

/// Processor time of this process, all of its threads, ms. `None` where the system does not tell.
pub(crate) fn process_ms() -> Option<f64> {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Some(time.tv_sec as f64 * 1e3 + time.tv_nsec as f64 * 1e-6)
    }
    #[cfg(not(unix))]
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn processor_time_passes_with_work() {
        let start = process_ms().unwrap();
        let mut x = 1.0_f64;
        while process_ms().unwrap() - start < 1.0 {
            x = std::hint::black_box(x).sqrt() + 1.0;
        }
        assert!(x > 1.0);
    }
}
