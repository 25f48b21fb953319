//! Reads a rule of the project: its subject and its tests.

use super::{GROUPS, HOUSE_RULE as RULE, HouseRule};
use crate::diagnostic::nearest;
use crate::language::grammar::{Form as _, HOUSE_RULE, TestedKind, both_languages};
use crate::language::scalar;
use crate::lint::path::{At, Shape};
use crate::lint::predicate::{Check, Test};
use crate::lint::rule::Level;
use crate::lint::settings::{Reader, error, meant};
use crate::syntax::{Node, NodeKind, Style};
use crate::text;
use regex_lite::Regex;
use serde_json::Value;

/// The maximum nesting of `all`, `any` and `not`.
const DEPTH: u8 = 16;

impl Reader<'_> {
    /// Reads a rule. `None` if it is malformed.
    pub(in crate::lint) fn rule(&mut self, node: Node<'_>) -> Option<HouseRule> {
        let kind = HOUSE_RULE.r#for.of(node)?.as_str()?;
        let on = match GROUPS.iter().find(|(name, _)| *name == kind) {
            Some((_, kinds)) => kinds.to_vec(),
            None => vec![TestedKind::KIND.word(kind)?],
        };
        let level = HOUSE_RULE.level.read(node);
        let shapes: Vec<Shape> = on.iter().map(|kind| Shape::of(kind)).collect();
        // Things of kinds that share a dump have the same paths.
        let shape = shapes.first()?;
        let only = HOUSE_RULE.r#where.of(node);
        let only = only.map_or(Some(Test::All(Vec::new())), |it| {
            self.test(it, shape, DEPTH)
        });
        let require = self.test(HOUSE_RULE.require.of(node)?, shape, DEPTH);
        Some(HouseRule {
            id: HOUSE_RULE.id.read(node)?,
            text: both_languages(node),
            level: level.map_or(Some(RULE.level), |it| Level::named(&it))?,
            on,
            only: only?,
            require: require?,
        })
    }

    /// Reads a mapping of tests by path, or by `all`, `any` and `not`. All of its entries must pass.
    fn test(&mut self, node: Node<'_>, shape: &Shape, depth: u8) -> Option<Test> {
        let Some(depth) = depth.checked_sub(1) else {
            let message = text!("判断嵌套太深", "the test is nested too deeply");
            let advice = text!("分成两条规则", "split the rule in two");
            return self.fault(node.span(), message, advice);
        };
        if node.as_mapping().is_none() {
            let advice = text!(
                "写出路径和应有的值，例如 `{{ effect: motion }}`",
                "write a path and its test: `{{ effect: motion }}`"
            );
            let message = text!("判断应为映射", "a test must be a mapping");
            return self.fault(node.span(), message, advice);
        }
        let mut tests = Vec::new();
        let mut is_sound = true;
        for entry in node.entries() {
            let test = match entry.name() {
                "all" => self.each(entry.value, shape, depth).map(Test::All),
                "any" => self.each(entry.value, shape, depth).map(Test::Any),
                "not" => {
                    let test = self.test(entry.value, shape, depth);
                    test.map(|test| Test::Not(Box::new(test)))
                }
                _ => self.at(entry.key, entry.value, shape),
            };
            is_sound &= test.is_some();
            tests.extend(test);
        }
        is_sound.then_some(Test::All(tests))
    }

    fn each(&mut self, node: Node<'_>, shape: &Shape, depth: u8) -> Option<Vec<Test>> {
        if node.as_sequence().is_none() {
            let advice = text!("在每项判断前写短横线", "write a dash before each test");
            let message = text!("`all` 和 `any` 应为列表", "`all` and `any` must be lists");
            return self.fault(node.span(), message, advice);
        }
        let tests = node.items().map(|item| self.test(item, shape, depth));
        tests.collect()
    }

    /// Reads the tests of one path.
    fn at(&mut self, key: Node<'_>, value: Node<'_>, shape: &Shape) -> Option<Test> {
        let path: Vec<String> = key.as_str()?.split('.').map(str::to_owned).collect();
        let mut at = shape.root();
        for (index, part) in path.iter().enumerate() {
            let mut keys = at.keys();
            if let Some(next) = keys.remove(part.as_str()) {
                at = next;
                continue;
            }
            if at.is_list() {
                let list = path.get(..index).unwrap_or_default().join(".");
                let advice = text!(
                    "改用 `present`、`absent`、`min_length` 或 `max_length`",
                    "use `present`, `absent`, `min_length` or `max_length`"
                );
                let message = text!(
                    "`{list}` 是列表，不能与值比较",
                    "`{list}` is a list and cannot be compared with a value"
                );
                return self.fault(key.span(), message, advice);
            }
            let message = text!(
                "`fcproto inspect` 的输出中没有键 `{part}`",
                "the output of `fcproto inspect` has no key `{part}` here"
            );
            let fault = error(key.span(), message);
            let near = nearest(part, keys.keys().copied());
            self.faults.push(if let Some(near) = near {
                let mut path = path.clone();
                if let Some(part) = path.get_mut(index) {
                    near.clone_into(part);
                }
                fault.fix(key.span(), path.join("."), meant(near))
            } else {
                let keys: Vec<_> = keys.into_keys().collect();
                let (zh, en) = (keys.join("、"), keys.join(", "));
                fault.note(text!("可以写：{zh}", "expected one of {en}"))
            });
            return None;
        }
        let mut checks = self.checks(value, &at)?;
        Some(match (checks.pop(), checks.is_empty()) {
            (Some(check), true) => Test::At(path, check),
            (last, _) => {
                let all = checks.into_iter().chain(last);
                Test::All(all.map(|check| Test::At(path.clone(), check)).collect())
            }
        })
    }

    fn checks(&mut self, node: Node<'_>, at: &At<'_>) -> Option<Vec<Check>> {
        const CHECKS: [&str; 7] = [
            "equals",
            "one_of",
            "matches",
            "min",
            "max",
            "min_length",
            "max_length",
        ];
        match node.kind() {
            NodeKind::Scalar(scalar) => Some(vec![match scalar.text {
                "present" => Check::Present,
                "absent" => Check::Absent,
                _ => Check::OneOf(vec![self.value(node, at)?]),
            }]),
            NodeKind::Mapping(entries) => {
                let mut checks = Vec::new();
                for entry in entries {
                    let value = entry.value;
                    checks.push(match entry.name() {
                        "equals" => Check::OneOf(vec![self.value(value, at)?]),
                        "one_of" => {
                            let values = value.items().map(|it| self.value(it, at));
                            Check::OneOf(values.collect::<Option<_>>()?)
                        }
                        "matches" => Check::Matches(self.pattern(value)?),
                        "min" => Check::Min(self.number(value)?),
                        "max" => Check::Max(self.number(value)?),
                        "min_length" => Check::MinLength(self.length(value)?),
                        "max_length" => Check::MaxLength(self.length(value)?),
                        _ => {
                            let what = text!("判断方式", "test");
                            return self.unknown(entry.key, &what, CHECKS.into_iter());
                        }
                    });
                }
                Some(checks)
            }
            NodeKind::Sequence(_) | NodeKind::Null => {
                let advice = text!(
                    "写 `present`、`absent`、一个值，或 `{{ one_of: [ … ] }}` 等",
                    "write `present`, `absent`, a value, or a test such as `{{ one_of: [ … ] }}`"
                );
                self.fault(node.span(), text!("缺少判断", "the test is empty"), advice)
            }
        }
    }

    /// Reads a value as the dump has it. If the schema lists words, the value must be one of them.
    fn value(&mut self, node: Node<'_>, at: &At<'_>) -> Option<Value> {
        let Some(scalar) = node.as_scalar() else {
            let advice = text!(
                "写文本、数值或布尔值",
                "write a text, a number or a boolean"
            );
            let message = text!("应为单个值", "expected a single value");
            return self.fault(node.span(), message, advice);
        };
        let words = at.words();
        if !words.is_empty() && !words.contains(&scalar.text) {
            return self.unknown(node, &text!("值", "value"), words.into_iter());
        }
        Some(match scalar.style {
            Style::Plain => match (scalar::bool(node), scalar::number(node)) {
                (Some(truth), _) => Value::Bool(truth),
                // An integer or a fraction always serializes.
                (_, Some(number)) => serde_json::to_value(number).unwrap_or_default(),
                _ => Value::String(scalar.text.to_owned()),
            },
            Style::Quoted | Style::Block => Value::String(scalar.text.to_owned()),
        })
    }

    fn pattern(&mut self, node: Node<'_>) -> Option<Regex> {
        let text = node.as_str().unwrap_or_default();
        match Regex::new(&format!("^(?:{text})$")) {
            Ok(pattern) => Some(pattern),
            Err(error) => {
                let error = error.to_string();
                let message = text!(
                    "不是正则表达式：{error}",
                    "this is not a regular expression: {error}"
                );
                let advice = text!("它要与整个文本匹配", "it is matched against the whole text");
                self.fault(node.span(), message, advice)
            }
        }
    }

    fn number(&mut self, node: Node<'_>) -> Option<f64> {
        let number = scalar::number(node).map(|number| number.to_f64());
        number.or_else(|| {
            let advice = text!(
                "例如 `3`、`0.5` 或 `0x0A00`",
                "such as `3`, `0.5` or `0x0A00`"
            );
            self.fault(node.span(), text!("应为数值", "expected a number"), advice)
        })
    }

    fn length(&mut self, node: Node<'_>) -> Option<usize> {
        let length = scalar::int(node).and_then(|length| usize::try_from(length).ok());
        length.or_else(|| {
            let message = text!("应为长度", "expected a length");
            self.fault(node.span(), message, text!("例如 `3`", "such as `3`"))
        })
    }
}
