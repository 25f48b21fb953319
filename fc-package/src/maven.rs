//! A repository in the layout of Maven.

use crate::error::PackError;
use crate::files;
use crate::sbom::Component;
use crate::sums;
use md5::Md5;
use sha1::Sha1;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The coordinates of an artifact.
#[derive(Clone, Debug)]
pub struct Coordinates {
    pub group: String,
    pub artifact: String,
    pub version: String,
}

impl Coordinates {
    /// Returns the coordinates of a version of an artifact.
    pub fn new(group: &str, artifact: &str, version: &str) -> Self {
        Self {
            group: group.to_owned(),
            artifact: artifact.to_owned(),
            version: version.to_owned(),
        }
    }

    /// Creates the directory of the artifact in a repository.
    pub fn directory(&self, repository: &Path) -> Result<PathBuf, PackError> {
        let mut directory = repository.to_owned();
        directory.extend(self.group.split('.'));
        files::directory(&directory.join(&self.artifact).join(&self.version))
    }

    /// Returns the name of a file of the artifact. `classifier` is empty or like `-sources`.
    pub fn file(&self, classifier: &str, extension: &str) -> String {
        let Self {
            artifact, version, ..
        } = self;
        format!("{artifact}-{version}{classifier}.{extension}")
    }

    /// Returns the POM of the artifact.
    pub fn pom(&self, description: &str, dependencies: &[Coordinates]) -> String {
        let mut needed = String::new();
        for dependency in dependencies {
            // Writing to a String cannot fail.
            let _ = write!(
                needed,
                "    <dependency>\n{}      <scope>compile</scope>\n    </dependency>\n",
                dependency.elements("      ")
            );
        }
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<project xmlns=\"http://maven.apache.org/POM/4.0.0\">\n  \
             <modelVersion>4.0.0</modelVersion>\n{}  <packaging>jar</packaging>\n  <name>{}</name>\n  \
             <description>{}</description>\n  <dependencies>\n{needed}  </dependencies>\n</project>\n",
            self.elements("  "),
            escaped(&self.artifact),
            escaped(description),
        )
    }

    /// Returns the artifact as a component of a bill of materials.
    pub fn component(&self) -> Component {
        Component {
            namespace: self.group.clone(),
            version: self.version.clone(),
            ..Component::new("maven", &self.artifact)
        }
    }

    fn elements(&self, indent: &str) -> String {
        let [group, artifact, version] =
            [&self.group, &self.artifact, &self.version].map(|it| escaped(it));
        format!(
            "{indent}<groupId>{group}</groupId>\n{indent}<artifactId>{artifact}</artifactId>\n{indent}<version>{version}</version>\n"
        )
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// Writes the checksums that Maven reads next to each file of a directory.
pub fn seal(directory: &Path) -> Result<(), PackError> {
    for file in files::entries(directory)? {
        let bytes = fs::read(&file)?;
        let name = file.display();
        files::write(format!("{name}.sha1").as_ref(), sums::hex::<Sha1>(&bytes))?;
        files::write(format!("{name}.md5").as_ref(), sums::hex::<Md5>(&bytes))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pom_has_escaped_elements_and_dependencies() {
        let robot = Coordinates::new("fc.robot", "a<b&c", "0.2.0-2024.9");
        let pom = robot.pom(
            "calls & reports",
            &[Coordinates::new("g", "library", "1.0")],
        );
        let expected = "\
<?xml version=\"1.0\" encoding=\"UTF-8\"?>
<project xmlns=\"http://maven.apache.org/POM/4.0.0\">
  <modelVersion>4.0.0</modelVersion>
  <groupId>fc.robot</groupId>
  <artifactId>a&lt;b&amp;c</artifactId>
  <version>0.2.0-2024.9</version>
  <packaging>jar</packaging>
  <name>a&lt;b&amp;c</name>
  <description>calls &amp; reports</description>
  <dependencies>
    <dependency>
      <groupId>g</groupId>
      <artifactId>library</artifactId>
      <version>1.0</version>
      <scope>compile</scope>
    </dependency>
  </dependencies>
</project>
";
        assert_eq!(pom, expected);
    }
}
