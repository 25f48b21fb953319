//! See `README.md`.

fn main() -> std::process::ExitCode {
    fc_bench::run()
}
