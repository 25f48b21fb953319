//! Runs the two TLS examples against each other, and against peers without a valid certificate or handshake.

use crate::support::programs::{Robot, examples};
use rcgen::{BasicConstraints, CertificateParams, IsCa, Issuer, KeyPair};
use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// An authority that signs certificates.
struct Authority {
    pem: String,
    issuer: Issuer<'static, KeyPair>,
}

impl Authority {
    fn new() -> Self {
        let key = KeyPair::generate().unwrap();
        let mut params = CertificateParams::new([]).unwrap();
        params.is_ca = IsCa::Ca(BasicConstraints::Unconstrained);
        let pem = params.self_signed(&key).unwrap().pem();
        let issuer = Issuer::new(params, key);
        Self { pem, issuer }
    }

    /// Writes a certificate for this host, and its key.
    fn sign(&self, folder: &Path, name: &str, host: &str) {
        let key = KeyPair::generate().unwrap();
        let params = CertificateParams::new([host.to_owned()]).unwrap();
        let signed = params.signed_by(&key, &self.issuer).unwrap();
        fs::write(folder.join(format!("{name}.pem")), signed.pem()).unwrap();
        fs::write(folder.join(format!("{name}.key")), key.serialize_pem()).unwrap();
    }

    /// Returns a folder for a program that trusts this authority.
    fn trusted(&self) -> TempDir {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("ca.pem"), &self.pem).unwrap();
        folder
    }
}

/// A robot, the app's program and the authority of both.
struct World {
    robot: Robot,
    app: PathBuf,
    authority: Authority,
    _folder: TempDir,
}

impl World {
    fn new() -> Self {
        let [robot, app] = examples(["tls_robot", "tls_app"], "");
        let authority = Authority::new();
        let folder = authority.trusted();
        authority.sign(folder.path(), "robot", "127.0.0.1");
        let args = ["--certificates", folder.path().to_str().unwrap()];
        Self {
            robot: Robot::start(&robot, &args),
            app,
            authority,
            _folder: folder,
        }
    }

    /// Runs the app with the certificates in a folder.
    fn app(&self, folder: &TempDir) -> Output {
        let [port, _] = self.robot.ports;
        Command::new(&self.app)
            .arg("--certificates")
            .arg(folder.path())
            .args(["--command-port", &port.to_string()])
            .output()
            .unwrap()
    }

    /// Asserts that the robot answers an app with a valid certificate.
    fn serves(&self) {
        let folder = self.authority.trusted();
        self.authority.sign(folder.path(), "app", "app");
        let output = self.app(&folder);
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let log = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}{log}");
        assert!(said.starts_with("answered: "), "{said}");
    }

    /// Asserts that the app fails, and that the robot logs the reason.
    fn refuses(&mut self, folder: &TempDir, why: &str) {
        let output = self.app(folder);
        assert!(!output.status.success());
        assert!(output.stdout.is_empty(), "{output:?}");
        // The app may have tried several times.
        self.robot.logs(&format!("the handshake failed: {why}"));
    }
}

#[test]
fn an_app_with_its_certificate_is_answered() {
    World::new().serves();
}

#[test]
fn foreign_certificate_is_refused_by_both_sides() {
    let mut world = World::new();
    let other = Authority::new();

    // Another authority signed the app's certificate.
    let folder = world.authority.trusted();
    other.sign(folder.path(), "app", "app");
    world.refuses(&folder, "invalid peer certificate");

    // The app trusts another authority.
    let folder = other.trusted();
    world.authority.sign(folder.path(), "app", "app");
    world.refuses(&folder, "received fatal alert");

    world.serves();
}

/// Peers that send plain bytes are refused, and silent peers block no other app.
#[test]
fn missing_handshake_blocks_no_other_app() {
    let mut world = World::new();
    let ports = world.robot.ports;
    let mut silent = Vec::new();
    for _ in 0..20 {
        for port in ports {
            silent.push(TcpStream::connect(("127.0.0.1", port)).unwrap());
        }
    }
    for port in ports {
        let mut plain = TcpStream::connect(("127.0.0.1", port)).unwrap();
        let _ = plain.write_all(&[0x41; 512]);
        let mut answer = Vec::new();
        // The robot sends at most an alert before it closes the connection.
        let _ = plain.read_to_end(&mut answer);
        assert!(answer.len() < 64, "{answer:?}");
        world.robot.logs("the handshake failed");
    }
    world.serves();
    drop(silent);
}
