//! Temporary crates with the same messages for fc and for prost.

use fc_bench_cases::synthetic;
use fc_codegen::emit::generate;
use fc_codegen::product::Product;
use fc_codegen::target::Targets;
use fc_spec::diagnostic::Faults;
use fc_spec::{load, syntax};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Instant, SystemTime};

/// Contents of a crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Types of fc, and a function that reads and writes each of them by its code.
    Fc,
    /// The same as [`Fc`](Self::Fc), with client and server.
    FcTokio,
    /// Types of prost, and a function that reads and writes each of them by its code.
    Prost,
}

/// A crate on disk.
pub struct Crate {
    root: PathBuf,
    kind: Kind,
}

/// A command of cargo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// `cargo check`.
    Check,
    /// `cargo build`.
    Debug,
    /// `cargo build --release`.
    Release,
}

const OURS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
const LOCK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.lock");

impl Crate {
    /// Writes a crate for this number of commands to `root`.
    pub fn new(root: PathBuf, kind: Kind, commands: usize) -> Self {
        fs::create_dir_all(root.join("src")).expect("a directory");
        let made = Self { root, kind };
        let dependencies = if kind == Kind::Prost { made.prost(commands) } else { made.ours(commands) };
        made.write("Cargo.toml", &manifest(&dependencies));
        fs::copy(LOCK, made.root.join("Cargo.lock")).expect("the versions of the benchmark");
        made
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.root.join(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("a directory");
        fs::write(path, text).expect("a file");
    }

    fn ours(&self, commands: usize) -> String {
        synthetic::write_spec(&self.root, commands).expect("the spec");
        let mut faults = Faults::new();
        let sources = syntax::read_dir(&self.root, Path::new("spec"), &mut faults);
        let model = load::load(&sources, &mut faults).model().expect("a sound spec");
        let made = generate(&model, &Targets::of([Product::Rust])).expect("no audience is named");
        for artifact in made {
            let place = artifact.path.split_once("/src/").map_or(&*artifact.path, |(_, name)| name);
            self.write(&format!("src/{place}"), &artifact.contents);
        }
        let tokio = self.kind == Kind::FcTokio;
        self.write("src/main.rs", if tokio { TOKIO_MAIN } else { MAIN });
        let default = if tokio { "\"client\", \"server\"" } else { "" };
        let runtime = if tokio { "tokio = { version = \"1\", features = [\"rt\"] }\n" } else { "" };
        format!(
            "fc-derive = {{ path = \"{OURS}/fc-derive\", default-features = false }}\n\
             fc-runtime = {{ path = \"{OURS}/fc-runtime\", default-features = false }}\n\
             futures-core = {{ version = \"0.3\", default-features = false, optional = true }}\n{runtime}\n\
             [features]\ndefault = [{default}]\nclient = [\"fc-derive/client\", \"fc-runtime/client\", \"dep:futures-core\"]\nserver = [\"fc-derive/server\", \"fc-runtime/server\"]\n"
        )
    }

    fn prost(&self, commands: usize) -> String {
        self.write("synthetic.proto", &synthetic::proto(commands));
        let descriptors = protox::compile(["synthetic.proto"], [&self.root]).expect("a sound file");
        let out = self.root.join("src");
        prost_build::Config::new().out_dir(out).compile_fds(descriptors).expect("the file is written");
        let mut library = "pub mod synthetic;\n\nuse prost::Message;\nuse synthetic::*;\n\n\
            fn again<M: Message + Default>(data: &[u8]) -> Option<Vec<u8>> {\n    Some(M::decode(data).ok()?.encode_to_vec())\n}\n\n\
            /// Reads and writes a message.\npub fn transcode(code: u16, data: &[u8]) -> Option<Vec<u8>> {\n    match code {\n"
            .to_owned();
        for code in 0..commands {
            let _ = writeln!(library, "        {} => again::<GetRecord{code:04}Request>(data),", code * 2);
            let _ = writeln!(library, "        {} => again::<GetRecord{code:04}Response>(data),", code * 2 + 1);
        }
        library.push_str("        _ => None,\n    }\n}\n");
        self.write("src/lib.rs", &library);
        self.write("src/main.rs", PROST_MAIN);
        "prost = \"0.14\"\n".to_owned()
    }

    fn cargo(&self, arguments: &[&str]) -> f64 {
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
        let start = Instant::now();
        let output = Command::new(cargo)
            .args(arguments)
            .args(["--offline", "--quiet", "--target-dir"])
            .arg(self.target())
            .current_dir(&self.root)
            .env("CARGO_INCREMENTAL", "0")
            .output()
            .expect("cargo runs");
        let seconds = start.elapsed().as_secs_f64();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        seconds
    }

    fn target(&self) -> PathBuf {
        self.root.join("target")
    }

    /// Removes all build results.
    pub fn clean(&self) {
        let _ = fs::remove_dir_all(self.target());
    }

    /// Marks the library as changed, runs an action on it, and returns the seconds. They include dependencies that are
    /// not built yet.
    pub fn act(&self, action: Action) -> f64 {
        let library = fs::File::options().append(true).open(self.root.join("src/lib.rs")).expect("the library");
        library.set_modified(SystemTime::now()).expect("a time");
        match action {
            Action::Check => self.cargo(&["check", "--lib"]),
            Action::Debug => self.cargo(&["build", "--lib"]),
            Action::Release => self.cargo(&["build", "--lib", "--release"]),
        }
    }

    /// Builds the stripped release program and returns its size in bytes.
    pub fn program_size(&self) -> f64 {
        self.cargo(&["build", "--release", "--bin", "generated", "--config", "profile.release.strip=true"]);
        let program = self.target().join("release/generated");
        fs::metadata(program).expect("the program").len() as f64
    }

    /// Returns the number of direct and indirect dependencies.
    pub fn dependencies(&self) -> usize {
        let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
        let output = Command::new(cargo)
            .args(["tree", "--offline", "--edges", "normal,build", "--prefix", "none", "--no-dedupe"])
            .current_dir(&self.root)
            .output()
            .expect("cargo runs");
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let names: std::collections::BTreeSet<&str> = text.lines().filter_map(|line| line.split(' ').next()).collect();
        names.len().saturating_sub(1)
    }
}

fn manifest(dependencies: &str) -> String {
    format!(
        "[workspace]\n\n[package]\nname = \"generated\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[dependencies]\n{dependencies}"
    )
}

/// A program that reads and writes its argument as every message.
const MAIN: &str = "\
fn main() {
    let input = std::env::args().nth(1).unwrap_or_default();
    for operation in generated::descriptors::OPERATIONS {
        for body in [operation.request, operation.response] {
            println!(\"{}\", (body.transcode)(input.as_bytes()).map_or(0, |out| out.len()));
        }
    }
}
";

const PROST_MAIN: &str = "\
fn main() {
    let input = std::env::args().nth(1).unwrap_or_default();
    for code in 0..u16::MAX {
        println!(\"{}\", generated::transcode(code, input.as_bytes()).map_or(0, |out| out.len()));
    }
}
";

/// A program with a robot that answers all commands and an app that calls all of them.
const TOKIO_MAIN: &str = "\
use fc_runtime::{ClientConfig, Message as _, Server, ServerConfig};
use generated::{Client, ExampleRobot, RobotService, for_each_command};

macro_rules! call_all {
    ($($method:ident $request:ident $response:ident;)*) => {
        async fn call_all(client: &Client) {
            $(let _ = client.$method(&generated::$request::example()).await;)*
        }
    };
}
for_each_command!(call_all);

fn main() {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    runtime.block_on(async {
        let config = ServerConfig::new().command_port(0).data_port(0);
        let server = Server::bind(config, RobotService::new(ExampleRobot::default())).await.unwrap();
        let port = server.command_addr().port();
        tokio::spawn(server.run());
        call_all(&Client::connect(ClientConfig::new().host(\"127.0.0.1\").command_port(port)).await.unwrap()).await;
    });
}
";
