//! Texts with a separator between them.

/// Joins texts without a list of them.
pub trait Joined: Iterator {
    /// Returns the texts with `between` between them.
    fn joined(self, between: &str) -> String;
}

impl<I: Iterator<Item: AsRef<str>>> Joined for I {
    fn joined(self, between: &str) -> String {
        let mut out = String::new();
        for (index, item) in self.enumerate() {
            if index > 0 {
                out.push_str(between);
            }
            out.push_str(item.as_ref());
        }
        out
    }
}
