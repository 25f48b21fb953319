//! `fcproto generate --watch`.
//!
//! An event of the file system only means that something may have changed. Each event makes the program read the spec
//! again and compare it. So there are no special cases for editors that save by renaming, for recreated directories,
//! and for files generated into the spec's directory.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::time::{Duration, Instant};

use fc_codegen::input::{FileChange, Input};
use notify::event::AccessKind;
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher as _};

use crate::lang::{both, said};
use crate::outcome::{Failure, Status};
use crate::project::Project;
use crate::project_dirs::ProjectDirs;
use crate::{plugin, print};

/// The time without events before the spec is read again. Editors and git change several files at once.
const CALM: Duration = Duration::from_millis(100);

/// The maximum time until the spec is read again, even if events continue.
const AT_MOST: Duration = Duration::from_secs(1);

/// Runs `work`, and runs it again after each change of the spec or `fc.yaml`, until Ctrl-C. Errors of the spec and
/// failures are shown, and the loop continues.
pub fn run(
    dirs: &ProjectDirs,
    work: impl Fn(&ProjectDirs) -> Result<Status, Failure>,
) -> Result<Status, Failure> {
    let root = dirs.find_root()?;
    let dirs = ProjectDirs {
        root: Some(root.clone()),
        spec: dirs.spec.clone(),
    };
    // One pending event is enough, whatever its number.
    let (sender, events) = sync_channel(1);
    let ended = Arc::new(AtomicBool::new(false));
    let (end, wake) = (Arc::clone(&ended), sender.clone());
    ctrlc::set_handler(move || {
        end.store(true, Ordering::Relaxed);
        plugin::end();
        let _ = wake.try_send(());
    })
    .map_err(|error| {
        said!(
            "无法等待 Ctrl-C：{error}",
            "cannot wait for Ctrl-C: {error}"
        )
    })?;
    let watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
        // Reading is not a change. Without this filter, each read of the spec would cause another one.
        let is_reading =
            |kind| matches!(kind, EventKind::Access(kind) if !matches!(kind, AccessKind::Any));
        if !event.is_ok_and(|event| is_reading(event.kind)) {
            let _ = sender.try_send(());
        }
    });
    let mut places = Watched {
        watcher: watcher.map_err(|error| cannot(&root, &error))?,
        paths: Vec::new(),
    };

    let mut last: Option<Input> = None;
    while !ended.load(Ordering::Relaxed) {
        let spec = spec(&dirs);
        // Watching starts before reading, so that no change is missed.
        places.renew(&root, &spec)?;
        let now = Input::read(&root, &spec);
        if last.as_ref() != Some(&now) {
            if let Some(last) = &last {
                print::done(&changed(&now.changes_since(last)))?;
            }
            if let Err(failure) = work(&dirs) {
                if print::is_closed_pipe(failure.as_ref()) {
                    return Err(failure);
                }
                print::failure(failure.as_ref());
            }
            last = Some(now);
            print::done(&said!(
                "等待改动；Ctrl-C 结束\n",
                "waiting for changes; Ctrl-C ends\n"
            ))?;
        }
        wait(&events);
    }
    Ok(Status::Fine)
}

/// Waits for a change, and then until no more follow.
fn wait(events: &Receiver<()>) {
    if events.recv().is_err() {
        return;
    }
    let begin = Instant::now();
    while begin.elapsed() < AT_MOST && events.recv_timeout(CALM).is_ok() {}
}

/// Returns the directory of the spec: the usual one while `fc.yaml` cannot be read.
fn spec(dirs: &ProjectDirs) -> PathBuf {
    Project::find(dirs).map_or_else(|_| dirs.usual_spec(), |project| project.spec)
}

fn cannot(path: &Path, error: &notify::Error) -> String {
    let path = path.display();
    said!(
        "无法监视 `{path}`：{error}",
        "cannot watch `{path}`: {error}"
    )
}

/// The watched paths.
struct Watched {
    watcher: RecommendedWatcher,
    paths: Vec<PathBuf>,
}

impl Watched {
    /// Watches the current directories. A directory that was removed and created again needs a new watch.
    fn renew(&mut self, root: &Path, spec: &Path) -> Result<(), Failure> {
        for path in self.paths.drain(..) {
            // The path may no longer exist.
            let _ = self.watcher.unwatch(&path);
        }
        let spec = root.join(spec);
        let mut wanted = vec![(root.to_owned(), RecursiveMode::NonRecursive)];
        // The directory above the spec reports when the spec is removed or created.
        if let Some(above) = spec.ancestors().skip(1).find(|above| above.is_dir())
            && above != root
        {
            wanted.push((above.to_owned(), RecursiveMode::NonRecursive));
        }
        if spec.is_dir() {
            wanted.push((spec, RecursiveMode::Recursive));
        }
        for (path, mode) in wanted {
            match self.watcher.watch(&path, mode) {
                Ok(()) => self.paths.push(path),
                // The path was just removed. The directory above reports when it is created again.
                Err(_) if !path.exists() => {}
                Err(error) => return Err(cannot(&path, &error).into()),
            }
        }
        Ok(())
    }
}

/// Returns a line for each changed file, up to a limit.
fn changed(changes: &[(FileChange, &str)]) -> String {
    let lines = changes.iter().map(|(change, path)| {
        let what = match change {
            FileChange::Added => both("新增", "new"),
            FileChange::Modified => both("改动", "changed"),
            FileChange::Removed => both("删除", "gone"),
        };
        said!("{what} {path}\n", "{what:<10} {path}\n")
    });
    let indent = both("     ", "           ");
    "\n".to_owned() + &print::first(lines, indent)
}
