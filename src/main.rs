//! The program: everything is in the library.

fn main() -> std::process::ExitCode {
    enfilade::cli::main().into()
}
