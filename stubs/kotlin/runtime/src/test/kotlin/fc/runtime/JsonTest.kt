package fc.runtime

import java.nio.charset.StandardCharsets

/** The rules of JSON alone, and the limits of the reader. */
internal fun jsonTests(tests: Tests) {
    fun check(name: String, expected: String?, found: String?) = tests.case(name) { expect(expected, found) }
    check("100,000 brackets", "too_deep", errorOf { Json.of("[".repeat(100_000)) })
    check("127 levels", null, errorOf { Json.of("[".repeat(127) + "]".repeat(127)) })
    check("128 levels", "too_deep", errorOf { Json.of("[".repeat(128) + "]".repeat(128)) })
    check("base64", "aGVsbG8=", Base64.encode("hello".toByteArray()))
    check("base64 back", "hello", Base64.decode("aGVsbG8=")?.toString(StandardCharsets.UTF_8))
    for (wrong in listOf("aGVsbG8", "aGVsbG9=", "aGVs*G8=", "=", "====")) {
        check("base64 $wrong", "null", Base64.decode(wrong)?.size.toString())
    }
    val text = "a\"\\\n\u0001机"
    val written = JsonWriter().beginObject().key(text).string(text).key("n").raw("1.0").endObject().text
    check("writing", "{\"a\\\"\\\\\\n\\u0001机\":\"a\\\"\\\\\\n\\u0001机\",\"n\":1.0}", written)
    for ((values, error) in listOf(3 to "too_many_values", 4 to null)) {
        check("$values values", error, errorOf {
            Bodies.decode(OneValue.of("json", Types.JSON), "{\"value\":[1,2,3]}".toByteArray(), Allowance(9, values, 1L shl 20))
        })
    }
    for ((bytes, error) in listOf(23L to "lists_too_large", 24L to null)) {
        check("lists of $bytes bytes", error, errorOf {
            val list = OneValue.of("list", Types.list(Types.I32))
            Bodies.decode(list, "{\"value\":[1,2,3]}".toByteArray(), Allowance(9, 99, bytes))
        })
    }
}
