//! Runs every target on its past finds, the files `fixtures/<target>/<name>`.

use std::fs;
use std::path::Path;

/// The target `memory` reads its counts.
#[global_allocator]
static ALLOCATOR: peak_alloc::PeakAlloc = fc_fuzz::COUNTING;

#[test]
fn every_find_stays_fixed() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    for (name, target) in fc_fuzz::TARGETS {
        let Ok(folder) = fs::read_dir(fixtures.join(name)) else {
            continue;
        };
        for fixture in folder {
            let path = fixture.unwrap().path();
            println!("{}", path.display());
            target(&fs::read(path).unwrap());
        }
    }
}
