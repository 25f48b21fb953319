//! Writes the measurements of the packages into the results pages.

use fc_bench_report::packages;
use std::process::ExitCode;

fn main() -> ExitCode {
    match write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn write() -> Result<(), String> {
    let reports = packages::read().map_err(|error| error.to_string())?;
    for (path, language) in packages::pages() {
        let told = |error: std::io::Error| format!("{}: {error}", path.display());
        let page = std::fs::read_to_string(&path).map_err(told)?;
        let page = packages::replaced(&page, &packages::block(&reports, language))?;
        std::fs::write(&path, page).map_err(told)?;
    }
    Ok(())
}
