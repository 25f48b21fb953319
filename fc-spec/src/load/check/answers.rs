//! Checks the parts that the source lacks, conflicts and their answers.

use crate::diagnostic::{Diagnostic, FaultCode, Faults};
use crate::language::grammar::{ANSWER, COMMAND, FILE, OPERATION, REPORT, SOURCE};
use crate::language::scalar::small_int;
use crate::load::draft::{Draft, Sourced};
use crate::model::{BodyState, Fact, Kind, Operation};
use crate::names::is_conflict_id;
use crate::source::Span;
use crate::text;
use crate::vocabulary::Word as _;
use std::collections::{BTreeMap, HashMap, HashSet};

/// Checks that a lost fact is inferred or open, never stated.
pub(super) fn check_lost(draft: &Draft<'_>, faults: &mut Faults) {
    for operation in &draft.operations {
        for node in SOURCE
            .lost
            .items(OPERATION.source.of(operation.origin.node))
        {
            let (item, origin) = (&operation.item, operation.origin);
            let Some(fact) = node.as_str().and_then(Fact::named) else {
                continue;
            };
            let what = fact.name();
            let stated_at = match (fact, item.kind()) {
                (Fact::Code, _) => origin.key_at(OPERATION.code),
                (Fact::Request, Kind::Command) => origin.key_at(COMMAND.request),
                (Fact::Request, Kind::Report) => origin.key_at(REPORT.body),
                (Fact::Response, Kind::Command | Kind::Report) => origin.key_at(COMMAND.response),
                _ => continue,
            };
            let mut states = [OPERATION.request_state, OPERATION.response_state].into_iter();
            let state = states.find(|key| key.name.starts_with(what));
            // An unreadable state key has its own error.
            let is_said = state.is_some_and(|key| key.of(origin.node).is_some());
            if is_said || item.fact_state(fact) != Some(BodyState::Stated) {
                continue;
            }
            let message = text!(
                "这里注明源文档缺失 {what}",
                "the {what} is marked as missing from the source document"
            );
            let said = text!(
                "这里却按源文档写明的内容书写",
                "but it is marked as stated here"
            );
            let remedy = match state {
                Some(key) => text!(
                    "改写为 `{key}: inferred` 或 `open`",
                    "write `{key}: inferred` or `open`",
                    key = key.name
                ),
                None => text!(
                    "改写为 `unassigned`，或 `{{ value: …, state: inferred }}`",
                    "write `unassigned`, or `{{ value: …, state: inferred }}`"
                ),
            };
            let fault = Diagnostic::error(FaultCode::LostButStated, node.span(), message);
            faults.push(fault.also(stated_at, said).note(remedy));
        }
    }
}

/// Checks that every conflict of an answer exists.
pub(super) fn check_known(draft: &Draft<'_>, faults: &mut Faults) {
    let known: HashSet<&str> = draft
        .conflicts
        .iter()
        .map(|conflict| conflict.item.id.as_str())
        .collect();
    // Answers without ids name their facts and need no conflict.
    let mut with_ids = draft
        .answers
        .iter()
        .filter(|answer| !answer.item.ids.is_empty());
    if let (true, Some(first)) = (known.is_empty(), with_ids.next()) {
        let answers = 1 + with_ids.count();
        let message = text!(
            "规范有 {answers} 条答复写了 `ids`，但没有 `conflicts`",
            "the spec has {answers} answers with `ids` but no `conflicts`"
        );
        let span = first.origin.at(ANSWER.ids);
        faults.push(
            Diagnostic::error(FaultCode::UnknownConflict, span, message)
                .label(text!("这是第一条", "this is the first"))
                .note(text!(
                    "在 `conflicts:` 下声明疑问；检查是否缺少那个文件",
                    "declare conflicts under `conflicts:`; check whether their file is missing"
                )),
        );
        return;
    }
    for answer in &draft.answers {
        for node in ANSWER.ids.items(answer.origin.node) {
            let id = node.as_str().unwrap_or_default();
            if known.contains(id) || !is_conflict_id(id) {
                continue;
            }
            let message = text!("没有疑问 {id}", "there is no conflict {id}");
            let fault = Diagnostic::error(FaultCode::UnknownConflict, node.span(), message);
            faults.push(fault.note(text!(
                "在 `conflicts:` 下声明",
                "declare it under `conflicts:`"
            )));
        }
    }
}

/// Checks that every conflict has an answer.
pub(super) fn check_answered(draft: &Draft<'_>, faults: &mut Faults) {
    let answered: HashSet<&str> = draft
        .answers
        .iter()
        .flat_map(|answer| answer.item.ids.iter().map(String::as_str))
        .collect();
    if draft.broken_answers {
        return;
    }
    for conflict in &draft.conflicts {
        if is_conflict_id(&conflict.item.id) && !answered.contains(conflict.item.id.as_str()) {
            let message = text!("{id} 没有答复", "{id} has no answer", id = conflict.item.id);
            let span = conflict.origin.name();
            let note = text!(
                "在相关内容的 `answers:` 下答复；还没有答案时写 `as: question`",
                "answer it under `answers:` where it belongs; write `as: question` if there is no answer yet"
            );
            let fault = Diagnostic::error(FaultCode::UnansweredConflict, span, message);
            faults.push(fault.note(note));
        }
    }
}

/// Checks the sections of the source up to the last known one. Each belongs to an operation or is listed as missing.
pub(super) fn check_sections(draft: &Draft<'_>, faults: &mut Faults) {
    // An operation without valid `sections` could use any of them, so no section counts as missing.
    let says_sections = |operation: &Sourced<'_, Operation>| {
        let source = OPERATION.source.of(operation.origin.node);
        SOURCE.sections.of(source).is_some_and(|sections| {
            let mut items = sections.items();
            sections.as_sequence().is_some() && items.all(|item| small_int::<u16>(item).is_some())
        })
    };
    if !draft.valid.contains_key(FILE.sections.name) || !draft.operations.iter().all(says_sections)
    {
        return;
    }
    let mut claimed: BTreeMap<u16, Span> = BTreeMap::new();
    for operation in &draft.operations {
        for node in SOURCE
            .sections
            .items(OPERATION.source.of(operation.origin.node))
        {
            if let Some(section) = small_int(node) {
                claimed.entry(section).or_insert(node.span());
            }
        }
    }
    let missing: HashMap<u16, Span> = draft
        .sections
        .iter()
        .map(|section| (section.item.section, section.origin.name()))
        .collect();
    for section in &draft.sections {
        let number = section.item.section;
        if let Some(claim) = claimed.get(&number) {
            let message = text!(
                "第 {number} 节列为缺失，却是某个接口的出处",
                "section {number} is listed as missing, but an operation names it as its source"
            );
            let span = section.origin.name();
            let fault = Diagnostic::error(FaultCode::MissingSectionUsed, span, message);
            faults.push(fault.also(*claim, text!("写作出处", "named as a source")));
        }
    }
    let mut before = 0;
    let mut known: Vec<(u16, Span)> = claimed.into_iter().chain(missing).collect();
    known.sort_unstable();
    for (section, span) in known {
        if section > before + 1 {
            let first = before + 1;
            let gap = match section - 1 {
                last if last == first => text!("第 {first} 节", "section {first} is"),
                last => text!("第 {first} 至 {last} 节", "sections {first} to {last} are"),
            };
            let message = text!(
                "{gap}既没有接口用到，也没有列为缺失",
                "{gap} neither used by an operation nor listed as missing",
                gap = gap
            );
            let note = text!(
                "写进相应接口的 `source`，或列在 `protocol.yaml` 的 `sections:` 下",
                "name it in the `source` of its operation, or under `sections:` in `protocol.yaml`"
            );
            let fault = Diagnostic::error(FaultCode::SectionGap, span, message).note(note);
            faults.push(fault.label(text!("下一个已知的章节", "the next known section")));
        }
        before = section;
    }
}
