//! C++.

use super::{Case, Language, Role, Words};

/// Keywords of C++17 and those of C++20 that a newer compiler refuses; macros of the C library; the types of the package.
pub static CPP: Language = Language {
    name: "cpp",
    title: "C++",
    case: |role| match role {
        Role::Type | Role::Value => Case::Pascal,
        Role::Field | Role::Method | Role::Module | Role::Function => Case::Snake,
    },
    keywords: Words::new(
        "alignas alignof and and_eq asm assert auto bitand bitor bool break case catch char char16_t char32_t \
        char8_t class co_await co_return co_yield compl concept const const_cast consteval constexpr \
        constinit continue decltype default delete do double dynamic_cast else enum errno explicit export \
        extern false float for friend goto if inline int long mutable namespace new noexcept not not_eq \
        nullptr operator or or_eq private protected public register reinterpret_cast requires return short \
        signed sizeof static static_assert static_cast stderr stdin stdout struct switch template this \
        thread_local throw true try typedef typeid typename union unsigned using virtual void volatile \
        wchar_t while xor xor_eq",
    ),
    types: Words::new(
        "AnyReport BOOL Client EOF ERROR ExampleRobot FALSE FILE NULL PartialRobot Reporter Reports \
        ResultCode Robot StreamCode TRUE Value",
    ),
    fields: Words::new("extra"),
    methods: Words::new(
        "close connect connect_lazy connection data follow reports server state states unknown",
    ),
    escape: |_, word| Some(format!("{word}_")),
    group_types: &[],
    has_file_per_type: false,
    has_id_types: false,
    has_field_types: false,
};
