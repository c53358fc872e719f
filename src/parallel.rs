//! Two things at once.

/// Runs `here` on this thread and `there` on one of its own, until both are done.
///
/// Not a job of rayon's: while its threads wait for the system or a driver, those that decode would be one less.
pub(crate) fn beside<A, B: Send>(here: impl FnOnce() -> A, there: impl FnOnce() -> B + Send) -> (A, B) {
    std::thread::scope(|scope| {
        let there = scope.spawn(there);
        let here = here();
        (here, there.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}
