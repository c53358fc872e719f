//! The `specula` program.

fn main() -> std::process::ExitCode {
    specula::cli::main()
}
