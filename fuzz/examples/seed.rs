//! Writes the first inputs of every corpus: golden frames, examples of all messages, and specs.
//!
//! Run it with `cargo run --release --example seed`.

use fc_fuzz::{MESSAGES, SEPARATOR};
use serde_json::Value;
use std::fs;
use std::io;
use std::path::Path;

fn main() -> io::Result<()> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = here.join("..");
    let corpus = here.join("corpus");
    let mut seeds = Seeds {
        corpus: &corpus,
        count: 0,
    };
    let mut vectors = 0;
    for entry in fs::read_dir(root.join("fc-generated/vectors"))? {
        let text = fs::read_to_string(entry?.path())?;
        let file: Value = serde_json::from_str(&text)?;
        for list in ["accepted", "rejected"] {
            for vector in file
                .get(list)
                .and_then(Value::as_array)
                .into_iter()
                .flatten()
            {
                vectors += 1;
                seeds.vector(vector)?;
            }
        }
    }
    for (index, message) in MESSAGES.iter().enumerate() {
        let index = u16::try_from(index).unwrap_or(0).to_le_bytes();
        seeds.write("bodies", &[&index, message.example.as_bytes()])?;
        for piece in REPEATED {
            let length = u8::try_from(piece.len()).unwrap_or(0);
            let head = [255, 63, 1, length];
            let parts: [&[u8]; 5] = [&index, &head, b"{", piece.as_bytes(), br#""z":0}"#];
            seeds.write("memory", &parts)?;
        }
    }
    seeds.session()?;
    seeds.spec(&root)?;
    println!(
        "{} seeds of {vectors} vectors, {} messages and the specs",
        seeds.count,
        MESSAGES.len()
    );
    Ok(())
}

/// Short JSON members that take much memory if they are repeated.
const REPEATED: [&str; 4] = [r#""a":[],"#, r#""":0,"#, r#""data":{},"#, r#""\n":"\n","#];

struct Seeds<'a> {
    corpus: &'a Path,
    count: usize,
}

impl Seeds<'_> {
    fn write(&mut self, target: &str, parts: &[&[u8]]) -> io::Result<()> {
        let folder = self.corpus.join(target);
        fs::create_dir_all(&folder)?;
        fs::write(
            folder.join(format!("seed-{:05}", self.count)),
            parts.concat(),
        )?;
        self.count += 1;
        Ok(())
    }

    fn vector(&mut self, vector: &Value) -> io::Result<()> {
        if let Some(body) = vector.get("bytes").and_then(Value::as_str).and_then(unhex) {
            return self.write("bodies", &[&[0, 0], &body]);
        }
        let Some(frame) = vector.get("frame").and_then(Value::as_str).and_then(unhex) else {
            return Ok(());
        };
        if frame.len() > 4096 {
            return Ok(());
        }
        for flags in [0, 3, 4] {
            self.write("frames", &[&[flags, 3, 1, 40, 7], &frame])?;
        }
        self.write("decode", &[&[1], &frame])
    }

    fn session(&mut self) -> io::Result<()> {
        // Opens two requests, answers one, waits, receives a report twice, loses requests, cancels one, and receives an
        // arbitrary frame. Two of the three heads start at the end of the ids.
        let steps: &[u8] = &[
            0, 0, 50, 2, 1, 0, 1, 1, 50, 2, 1, 0, 2, 0, 0, 4, 60, 5, 1, 0, 3, 0, 5, 1, 0, 3, 0, 6,
            1, 3, 1, 0, 7, 1, 1, 1, 0, 0, 0, 0, 0,
        ];
        for head in [[5, 4, 50, 2, 0, 1], [19, 7, 5, 1, 1, 9], [1, 0, 0, 0, 0, 0]] {
            self.write("session", &[&head, steps])?;
        }
        Ok(())
    }

    fn spec(&mut self, root: &Path) -> io::Result<()> {
        for folder in ["fc-spec/tests/good", "fc-codegen/tests/docs/spec"] {
            let mut text = String::new();
            gather(&root.join(folder), "spec", &mut text)?;
            if !text.is_empty() {
                self.write("spec", &[text.as_bytes()])?;
            }
        }
        for folder in [
            "fc-spec/tests/bad",
            "fc-spec/tests/adversarial",
            "spec/commands",
            "spec",
        ] {
            for entry in fs::read_dir(root.join(folder))? {
                let path = entry?.path();
                if path.extension().is_some_and(|end| end == "yaml") {
                    let bytes = fs::read(path)?;
                    if bytes.len() < 16_384 {
                        self.write("spec", &[&bytes])?;
                    }
                }
            }
        }
        Ok(())
    }
}

/// Appends all YAML files below `folder` to one input.
fn gather(folder: &Path, name: &str, text: &mut String) -> io::Result<()> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Ok(());
    };
    let mut entries: Vec<_> = entries.collect::<Result<_, _>>()?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        let name = format!("{name}/{}", entry.file_name().to_string_lossy());
        if path.is_dir() {
            gather(&path, &name, text)?;
        } else if path.extension().is_some_and(|end| end == "yaml") {
            text.push_str(&format!(
                "{SEPARATOR}{name}\n{}\n",
                fs::read_to_string(path)?
            ));
        }
    }
    Ok(())
}

fn unhex(text: &str) -> Option<Vec<u8>> {
    let pairs = text.as_bytes().chunks(2);
    pairs
        .map(|pair| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok())
        .collect()
}
