//! The certificates of both sides. Each side has one, and trusts those that one authority has
//! signed.

#![allow(dead_code, reason = "each example uses a part of it")]

use super::support::Fault;
use std::path::PathBuf;
use std::sync::Arc;
use tokio_rustls::rustls::pki_types::pem::PemObject;
use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer};
use tokio_rustls::rustls::server::WebPkiClientVerifier;
use tokio_rustls::rustls::{ClientConfig, RootCertStore, ServerConfig};

/// PEM files: `ca.pem`, and the program's certificate and key.
pub struct Files {
    /// Folder of all files.
    pub folder: PathBuf,
    /// `robot` for `robot.pem` and `robot.key`.
    pub name: &'static str,
}

// #region certificates
impl Files {
    /// 机器人一侧：app 没有由 ca.pem 签发的证书，握手就失败。
    /// The robot's side: without a certificate signed by ca.pem, the handshake of an app fails.
    pub fn server(&self) -> Result<Arc<ServerConfig>, Fault> {
        let apps = WebPkiClientVerifier::builder(Arc::new(self.authority()?)).build()?;
        let (chain, key) = self.own()?;
        let config = ServerConfig::builder()
            .with_client_cert_verifier(apps)
            .with_single_cert(chain, key)?;
        Ok(Arc::new(config))
    }

    /// app 一侧：机器人的证书要由 ca.pem 签发，并写明所连接的主机名。
    /// The app's side: the robot's certificate must be signed by ca.pem and name the host that the
    /// app connects to.
    pub fn client(&self) -> Result<Arc<ClientConfig>, Fault> {
        let (chain, key) = self.own()?;
        let config = ClientConfig::builder()
            .with_root_certificates(self.authority()?)
            .with_client_auth_cert(chain, key)?;
        Ok(Arc::new(config))
    }

    fn authority(&self) -> Result<RootCertStore, Fault> {
        let mut store = RootCertStore::empty();
        store.add(CertificateDer::from_pem_file(self.folder.join("ca.pem"))?)?;
        Ok(store)
    }

    fn own(&self) -> Result<(Vec<CertificateDer<'static>>, PrivateKeyDer<'static>), Fault> {
        let file = |end| self.folder.join(format!("{}.{end}", self.name));
        let chain = CertificateDer::pem_file_iter(file("pem"))?.collect::<Result<_, _>>()?;
        Ok((chain, PrivateKeyDer::from_pem_file(file("key"))?))
    }
}
// #endregion certificates
