//! Compares the keys at which errors lie with the errors that the language reference declares for each key.

use fc_spec::diagnostic::{Diagnostic, FaultCode, Faults};
use fc_spec::index::{Occurrence, Role, visit};
use fc_spec::language::{Part, reference};
use fc_spec::source::Sources;
use fc_spec::syntax::parse;
use std::collections::BTreeSet;

/// Keys that hold a body. The checks of a body are the same under each of them.
const BODIES: [&str; 5] = ["request", "response", "body", "fields", "items"];

/// Errors that were found: the part of the language, its key, and the code.
pub type Raised = BTreeSet<(&'static str, &'static str, FaultCode)>;

/// Returns `true` for errors without a key. Errors of YAML may lie anywhere. `SplitItem` is about a whole item, whose
/// place does not name the list.
fn has_no_key(code: FaultCode) -> bool {
    code.as_str().starts_with("FC00") || code == FaultCode::SplitItem
}

/// Returns `true` for errors of the shape, which follow from the kind of a key.
fn is_of_shape(code: FaultCode) -> bool {
    code.as_str().starts_with("FC01")
}

/// Returns the part and the key at which an error lies. For a whole mapping, this is the key above it. The key is
/// `None` if the part does not have it.
fn place(sources: &Sources, fault: &Diagnostic) -> Option<(&'static str, Option<&'static str>)> {
    let span = fault.primary.span;
    let (id, file) = sources.iter().find(|(id, _)| *id == span.file)?;
    let tree = parse(id, &file.text, &mut Faults::new())?;
    let mut found = ("file", None);
    let mut see = |occurrence: Occurrence<'_>| {
        let at = occurrence.node.span();
        let is_whole = occurrence.role == Role::Key && at.start == span.start && at.end < span.end;
        if at.start <= span.start && !is_whole {
            found = (occurrence.part, occurrence.key);
        }
    };
    visit(tree.root(), &mut see);
    Some(found)
}

/// Adds the place of each error to `raised`. Returns the errors that the language reference does not declare at their
/// place.
pub fn undeclared(
    what: &str,
    sources: &Sources,
    faults: &Faults,
    raised: &mut Raised,
) -> Vec<String> {
    let parts = reference();
    let part = |id: &str| parts.iter().find(|part| part.id == id);
    let says = |id: &str, name: Option<&'static str>, code: FaultCode| {
        let of_whole = |part: &Part| part.faults.contains(&code);
        let Some(part_of) = part(id) else {
            return false;
        };
        let Some(name) = name else {
            return of_whole(part_of);
        };
        part_of.keys.iter().any(|key| {
            let mut inner = key.takes.iter().flat_map(|takes| &takes.parts);
            key.name == name
                && (key.faults.contains(&code)
                    || of_whole(part_of)
                    || inner.any(|id| part(id).is_some_and(of_whole)))
        })
    };
    let mut missing = Vec::new();
    for fault in faults {
        let Some((part, key)) = place(sources, fault).filter(|_| !has_no_key(fault.code)) else {
            continue;
        };
        raised.extend(key.map(|key| (part, key, fault.code)));
        if !says(part, key, fault.code) {
            missing.push(format!(
                "{what}: {} at {part}.{}",
                fault.code,
                key.unwrap_or("?")
            ));
        }
    }
    missing
}

/// Returns the errors that are declared for a key but not in `raised`, except those in `known`. Entries of `known` that
/// are not needed are errors too. Keys of the same name count as one.
pub fn unraised(raised: &Raised, known: &[(&str, &str)]) -> Vec<String> {
    let kin = |name: &'static str| if BODIES.contains(&name) { "body" } else { name };
    let raised: BTreeSet<_> = raised
        .iter()
        .map(|(_, key, code)| (kin(key), *code))
        .collect();
    let declared = reference().into_iter().flat_map(|part| part.keys);
    let declared: BTreeSet<_> = declared
        .flat_map(|key| {
            key.faults
                .into_iter()
                .map(move |code| (kin(key.name), code))
        })
        .filter(|(_, code)| !is_of_shape(*code))
        .collect();
    let is_known = |key: &str, code: FaultCode| known.contains(&(key, code.as_str()));
    let unraised = declared.difference(&raised);
    let mut wrong: Vec<String> = unraised
        .filter(|(key, code)| !is_known(key, *code))
        .map(|(key, code)| format!("nothing raises {code} at `{key}`"))
        .collect();
    // An exception that is not needed must be removed.
    let is_idle = |(key, code): &&(&str, &str)| {
        let pair = |(name, it): &(&str, FaultCode)| name == key && it.as_str() == *code;
        raised.iter().any(pair) || !declared.iter().any(pair)
    };
    let idle = known.iter().filter(is_idle);
    wrong.extend(idle.map(|(key, code)| format!("{code} at `{key}` is no exception any more")));
    wrong
}
