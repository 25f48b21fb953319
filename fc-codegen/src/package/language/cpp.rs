//! C++.

use super::{Case, Language, Role, Words};

/// C++ with plain integers and strings as ids.
pub static CPP: Language = cpp(Some(&CPP_WITH_IDS));

/// C++ with an id type for each entity: `newtypes: true` in `fc.yaml`.
static CPP_WITH_IDS: Language = cpp(None);

/// Builds the rules of C++.
///
/// The reserved words include the keywords of C++17, and those of C++20, which newer compilers refuse. They also
/// include macros of GCC (`linux`), of the C library and of POSIX. The types are those of the package.
const fn cpp(with_ids: Option<&'static Language>) -> Language {
    Language {
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
            wchar_t while xor xor_eq \
            alloca be16toh be32toh be64toh d_fileno h_addr h_errno htobe16 htobe32 htobe64 htole16 htole32 htole64 i386 \
            le16toh le32toh le64toh linux major makedev math_errhandling minor mips offsetof s6_addr s6_addr16 s6_addr32 \
            sa_handler sa_sigaction sched_priority setjmp si_addr si_band si_fd si_int si_lower si_overrun si_pid si_ptr \
            si_status si_stime si_syscall si_timerid si_uid si_upper si_utime si_value sigmask sigsetjmp st_atime st_ctime \
            st_mtime strdupa strndupa timeradd timerclear timercmp timerisset timersub unix va_arg va_copy va_end va_start",
        ),
        types: Words::new(
            "AnyReport BOOL Client ECHO EOF ERROR ExampleRobot FALSE FAR FILE INFINITY NAN NULL PartialRobot Reporter \
            Reports ResultCode Robot StreamCode Streamer Streams TRUE Value",
        ),
        fields: Words::new("extra"),
        methods: Words::new(
            "close connect connect_lazy connection data follow reports server state states unknown",
        ),
        escape: |_, word| Some(format!("{word}_")),
        group_types: &[],
        has_file_per_type: false,
        has_id_types: with_ids.is_none(),
        with_ids,
        has_field_types: false,
    }
}
