//! `fcproto generate --watch`.
//!
//! What the file system tells says only that something may have changed: what has is found out by reading the spec again. So
//! neither an editor that saves by renaming, nor a directory that comes back, nor what is generated into the spec's own
//! directory needs a case of its own.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use fc_codegen::target::FILE;
use fc_spec::diagnostic::Faults;
use fc_spec::syntax::read_dir;
use notify::event::AccessKind;
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher as _};

use crate::lang::{lang, said};
use crate::outcome::{Failure, Status};
use crate::place::Place;
use crate::project::{Project, settings};
use crate::{plugin, print};

/// Nothing must change for so long before the spec is read again: editors and git change several files at once.
const CALM: Duration = Duration::from_millis(100);

/// What changes all the time is read in between nevertheless.
const AT_MOST: Duration = Duration::from_secs(1);

/// Files that are named one by one.
const NAMED: usize = 10;

/// Does the work, and does it again whenever the spec or `fc.yaml` has changed, until Ctrl-C. Faults of the spec and
/// failures are shown; neither ends it.
pub fn run(
    place: &Place,
    work: impl Fn(&Place) -> Result<Status, Failure>,
) -> Result<Status, Failure> {
    let root = Project::root(place)?;
    let place = Place {
        root: Some(root.clone()),
        spec: place.spec.clone(),
    };
    // One event says as much as many.
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
        // Reading is no change, and the spec is read after each.
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
        let spec = spec(&place);
        // Before reading, so that what changes from here on is told.
        places.renew(&root, &spec)?;
        let now = Input::read(&root, &spec);
        if last.as_ref() != Some(&now) {
            print::done(
                &last
                    .as_ref()
                    .map_or_else(String::new, |last| now.since(last)),
            )?;
            if let Err(failure) = work(&place) {
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

/// Until something has changed and calm has returned.
fn wait(events: &Receiver<()>) {
    if events.recv().is_err() {
        return;
    }
    let begin = Instant::now();
    while begin.elapsed() < AT_MOST {
        if let Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) =
            events.recv_timeout(CALM)
        {
            return;
        }
    }
}

/// Where the spec is: at its usual place while `fc.yaml` cannot be read.
fn spec(place: &Place) -> PathBuf {
    Project::find(place).map_or_else(|_| Project::usual_spec(place), |project| project.spec)
}

fn cannot(path: &Path, error: &notify::Error) -> String {
    let path = path.display();
    said!(
        "无法监视 `{path}`：{error}",
        "cannot watch `{path}`: {error}"
    )
}

/// What is watched.
struct Watched {
    watcher: RecommendedWatcher,
    paths: Vec<PathBuf>,
}

impl Watched {
    /// Watches what is there now: a directory that was removed and made again is another one.
    fn renew(&mut self, root: &Path, spec: &Path) -> Result<(), Failure> {
        for path in self.paths.drain(..) {
            // It may be gone.
            let _ = self.watcher.unwatch(&path);
        }
        let spec = root.join(spec);
        let mut wanted = vec![(root.to_owned(), RecursiveMode::NonRecursive)];
        // What is above the spec tells of it when it goes and comes.
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
                // Gone since a moment ago, of which what is above it tells.
                Err(_) if !path.exists() => {}
                Err(error) => return Err(cannot(&path, &error).into()),
            }
        }
        Ok(())
    }
}

/// All that is generated from, as it was when it was read.
#[derive(PartialEq)]
struct Input {
    /// Paths and texts, sorted by path.
    files: Vec<(String, String)>,
    /// Codes of what could not be read.
    faults: Vec<&'static str>,
}

impl Input {
    fn read(root: &Path, spec: &Path) -> Self {
        let mut faults = Faults::new();
        let sources = read_dir(root, spec, &mut faults);
        let files = sources.iter();
        let mut files: Vec<_> = files
            .map(|(_, file)| (file.path.clone(), file.text.clone()))
            .collect();
        if let Ok(Some(text)) = settings(root) {
            files.push((FILE.to_owned(), text));
        }
        files.sort();
        Self {
            files,
            faults: faults.iter().map(|it| it.code.as_str()).collect(),
        }
    }

    /// Which files are others than they were.
    fn since(&self, last: &Self) -> String {
        let lacks = |input: &Self, path: &str| !input.files.iter().any(|(it, _)| it == path);
        let new = self.files.iter().filter(|file| !last.files.contains(file));
        let new = new.map(|(path, _)| {
            let what = if lacks(last, path) {
                lang().pick("新增", "new")
            } else {
                lang().pick("改动", "changed")
            };
            (what, path)
        });
        let gone = last
            .files
            .iter()
            .map(|(path, _)| (lang().pick("删除", "gone"), path));
        let all: Vec<_> = new
            .chain(gone.filter(|(_, path)| lacks(self, path)))
            .collect();
        let mut text = "\n".to_owned();
        for (what, path) in all.iter().take(NAMED) {
            text += &said!("{what} {path}\n", "{what:<10} {path}\n");
        }
        if all.len() > NAMED {
            let more = all.len() - NAMED;
            text += &said!("     另有 {more} 个\n", "           and {more} more\n");
        }
        text
    }
}
