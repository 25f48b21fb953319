//! A test attribute with a time limit.
//!
//! A test that hangs fails with a message, instead of blocking the whole run.

use proc_macro::{Delimiter, Group, TokenStream, TokenTree};

/// The default time limit of a test in seconds. It is many times the duration of the slowest test, so that a busy
/// machine causes no failures.
const LIMIT: &str = "60";

/// A test, synchronous or asynchronous, that fails if it exceeds a time limit.
///
/// The test runs in a separate thread. The limit is a minute, or the `Duration` expression in `within = …`. A test that
/// does not end keeps its thread until the process ends.
///
/// An `async fn` gets a tokio runtime, with one thread by default. All other arguments are those of `#[tokio::test]`.
/// With `start_paused = true` it fails immediately if it is idle and its next timer is more than a week away.
#[proc_macro_attribute]
pub fn test(arguments: TokenStream, item: TokenStream) -> TokenStream {
    let (within, runtime) = split(arguments);
    let limit =
        within.unwrap_or_else(|| code(&format!("::core::time::Duration::from_secs({LIMIT})")));
    let is_paused = mentions(&runtime, "start_paused");

    let mut head: Vec<TokenTree> = item.into_iter().collect();
    let Some(TokenTree::Group(body)) = head.pop() else {
        return code("::core::compile_error!(\"not a function\");");
    };
    let named = head.iter().position(|token| is(token, "fn"));
    let Some(name) = named
        .and_then(|at| head.get(at + 1))
        .map(ToString::to_string)
    else {
        return code("::core::compile_error!(\"not a function\");");
    };
    let is_async = head.iter().any(|token| is(token, "async"));
    head.retain(|token| !is(token, "async"));

    let mut test = TokenStream::new();
    if is_async {
        let flavor = if mentions(&runtime, "flavor") {
            ""
        } else {
            "flavor = \"current_thread\","
        };
        test.extend(code(&format!("#[::tokio::main({flavor} {runtime})] async")));
    }
    test.extend(code("fn test()"));
    test.extend([if is_async && is_paused {
        braced(ends_when_idle(body))
    } else {
        TokenTree::Group(body)
    }]);
    test.extend(code(&format!(
        "let (running, over) = ::std::sync::mpsc::channel::<::core::convert::Infallible>();
        let test = ::std::thread::Builder::new().name(\"{name}\".to_owned()).spawn(move || {{
            let _running = running;
            test();
        }});
        let (test, limit) = (test.expect(\"a thread\"), {limit});
        let over = over.recv_timeout(limit);
        assert!(
            over != Err(::std::sync::mpsc::RecvTimeoutError::Timeout),
            \"not over after {{limit:?}}\"
        );
        if let Err(panic) = test.join() {{
            ::std::panic::resume_unwind(panic);
        }}"
    )));

    let mut whole = code("#[::core::prelude::v1::test]");
    whole.extend(head);
    whole.extend([braced(test)]);
    whole
}

/// Returns the body of a test that fails if paused time has no timer within a week.
fn ends_when_idle(body: Group) -> TokenStream {
    let mut timed = code("::core::time::Duration::from_secs(7 * 24 * 60 * 60), async");
    timed.extend([TokenTree::Group(body)]);
    let mut whole = code("let over = ::tokio::time::timeout");
    whole.extend([TokenTree::Group(Group::new(Delimiter::Parenthesis, timed))]);
    whole.extend(code(
        ".await; assert!(over.is_ok(), \"waits for what never comes\");",
    ));
    whole
}

/// Returns the expression after `within =`, and the other arguments.
fn split(arguments: TokenStream) -> (Option<TokenStream>, TokenStream) {
    let mut within = None;
    let mut others = TokenStream::new();
    let tokens: Vec<TokenTree> = arguments.into_iter().collect();
    for argument in tokens.split(|token| token.to_string() == ",") {
        match argument {
            [name, _equals, value @ ..] if is(name, "within") => {
                within = Some(value.iter().cloned().collect());
            }
            [] => {}
            _ => {
                others.extend(argument.iter().cloned());
                others.extend(code(","));
            }
        }
    }
    (within, others)
}

fn mentions(tokens: &TokenStream, name: &str) -> bool {
    tokens.clone().into_iter().any(|token| is(&token, name))
}

fn is(token: &TokenTree, name: &str) -> bool {
    matches!(token, TokenTree::Ident(ident) if ident.to_string() == name)
}

fn braced(inside: TokenStream) -> TokenTree {
    TokenTree::Group(Group::new(Delimiter::Brace, inside))
}

#[expect(clippy::expect_used, reason = "the text is ours")]
fn code(text: &str) -> TokenStream {
    text.parse().expect("Rust")
}
