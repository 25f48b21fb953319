package fc.runtime

import java.io.File

/** Patterns match as specified in `conformance/patterns.json`, in all languages. */
internal fun patternTests(tests: Tests) {
    for (pattern in Tree.of(File(tests.root, "conformance/patterns.json")).items) {
        val portable = pattern.find("portable")?.text ?: continue
        val codec = Types.STRING.pattern(portable)
        for (verdict in listOf("matches", "refuses")) {
            for (text in pattern[verdict].items.map { it.text }) {
                tests.case("$portable on `$text`", "patterns") {
                    val expected = if (verdict == "matches") null else "bad_pattern"
                    expect(expected, errorOf { codec.check(text, false) })
                }
            }
        }
    }
}
