package fc.runtime

/** A message with one optional key, `value`, and unknown keys, as in `bodies.json`. */
internal class OneValue<T : Any> private constructor(content: Content, override val messageType: Type<T>) : Message(content) {
    val value: T? get() = get(messageType.value)

    class Type<T : Any>(name: String, codec: Codec<T>) : MessageType<OneValue<T>>(name) {
        val value: OptionalField<T> = optional("value", codec)

        override fun create(content: Content): OneValue<T> = OneValue(content, this)
    }

    companion object {
        fun <T : Any> of(name: String, codec: Codec<T>): Type<T> = Type(name, codec)
    }
}

private val TYPES: Map<String, MessageType<*>> = listOf(
    OneValue.of("i8", Types.I8), OneValue.of("i16", Types.I16), OneValue.of("i32", Types.I32), OneValue.of("i64", Types.I64),
    OneValue.of("u8", Types.U8), OneValue.of("u16", Types.U16), OneValue.of("u32", Types.U32), OneValue.of("u64", Types.U64),
    OneValue.of("f32", Types.F32), OneValue.of("f64", Types.F64), OneValue.of("string", Types.STRING),
    OneValue.of("base64", Types.BASE64), OneValue.of("json", Types.JSON),
    OneValue.of("timestamp_ms", Types.I64), OneValue.of("timestamp_s", Types.I64),
    OneValue.of("object", OneValue.of("inner", Types.I32)),
).associateBy { it.name }

/** `bodies.json`: JSON itself, by the type of a value. */
internal fun bodyTests(tests: Tests) {
    val file = Tree.of(java.io.File(tests.root, "fc-generated/vectors/bodies.json"))
    for (case in file["accepted"].items) {
        tests.case("bodies: ${case["name"].text}", "bodies") {
            val type = TYPES.getValue(case["type"].text)
            val message = Bodies.decode(type, hex(case["bytes"].text), Allowance.DEFAULT)
            message.check()
            val written = message.toJson().text
            val isFloat = case["type"].text.startsWith("f")
            if (isFloat) {
                expect(Tree.of(case["written"].text).find("value")?.text?.toDouble(), Tree.of(written).find("value")?.text?.toDouble())
            } else {
                // The escapes of strings may have another spelling.
                val same = written == case["written"].text || Tree.of(written).toString() == Tree.of(case["written"].text).toString()
                expect(true, same) { "$written instead of ${case["written"].text}:" }
            }
        }
    }
    for (case in file["rejected"].items) {
        tests.case("bodies: ${case["name"].text}", "bodies") {
            val type = TYPES.getValue(case["type"].text)
            expect(case["error"].text, errorOf { Bodies.decode(type, hex(case["bytes"].text), Allowance.DEFAULT) })
        }
    }
}

/** The options of fields, and the functions of a message. */
internal fun messageTests(tests: Tests) {
    fun fault(codec: Codec<*>, json: String): String? = errorOf { OneValue.of("test", codec).fromJson("{\"value\":$json}") }

    val codecs: List<Triple<Codec<*>, List<String>, List<Pair<String, String>>>> = listOf(
        Triple(Types.I32.quoted(), listOf("\"5\"", "\"5.0\"", "\"-1\""), listOf(
            "5" to "wrong_type", "\" 5\"" to "wrong_type", "\"5 \"" to "wrong_type", "\"\"" to "wrong_type",
            "\"99999999999\"" to "out_of_range", "\"0x5\"" to "wrong_type",
        )),
        Triple(Types.BOOL.quoted(), listOf("\"true\"", "\"false\""), listOf("true" to "wrong_type", "\"1\"" to "wrong_type")),
        Triple(Types.BOOL_AS_NUMBER, listOf("1", "0", "1.0"), listOf("true" to "wrong_type", "2" to "wrong_type")),
        Triple(Types.BOOL.quoted().lenient(), listOf("\"true\"", "true", "1", "0.0"), listOf(
            "2" to "wrong_type", "\"1\"" to "wrong_type", "null0" to "bad_json",
        )),
        Triple(Types.I32.lenient(), listOf("5", "\"5\"", "\"0x1F\"", "\"0Xff\""), listOf(
            "\"0xFFFFFFFF\"" to "out_of_range", "\"0x\"" to "wrong_type", "\"0x+5\"" to "wrong_type", "\"five\"" to "wrong_type",
        )),
        Triple(Types.F64.lenient(), listOf("0.5", "\"0.5\"", "\"0x10\""), listOf("\"\"" to "wrong_type", "\"1e999\"" to "out_of_range")),
        Triple(Types.F32.min(0).max(1.5), listOf("0", "1.5"), listOf("-0.1" to "out_of_range", "1.6" to "out_of_range")),
        Triple(Types.U64.max(Long.MAX_VALUE), listOf("9223372036854775807"), listOf("9223372036854775808" to "out_of_range")),
        Triple(Types.STRING.length(1, 3), listOf("\"机器人\"", "\"😀😀😀\""), listOf("\"\"" to "bad_length", "\"abcd\"" to "bad_length")),
        Triple(Types.STRING.pattern("[0-9]+|x"), listOf("\"12\"", "\"x\""), listOf("\"12a\"" to "bad_pattern", "\"12\\n\"" to "bad_pattern")),
        Triple(Types.list(Types.I32.min(1)).length(1, 2), listOf("[1]", "[1,2]"), listOf(
            "[]" to "bad_length", "[1,0]" to "out_of_range", "[1,2,3]" to "bad_length", "[null]" to "wrong_type",
        )),
        Triple(Types.BASE64.length(2, 2), listOf("\"aGk=\""), listOf("\"aA==\"" to "bad_length", "\"a\"" to "bad_base64")),
        Triple(Mood.only(1, 2), listOf("1", "2.0"), listOf("3" to "out_of_range", "9" to "out_of_range", "\"1\"" to "wrong_type")),
        Triple(Mood.quoted(), listOf("\"1\"", "\"77\""), listOf("1" to "wrong_type")),
        Triple(Closed, listOf("\"a\""), listOf("\"b\"" to "unknown_value", "1" to "wrong_type")),
        Triple(Either, listOf("{\"a\":1}", "{\"b\":1}", "{\"a\":1,\"b\":2}"), listOf(
            "{}" to "no_variant", "{\"c\":1}" to "no_variant", "1" to "wrong_type", "{\"a\":\"\"}" to "wrong_type",
        )),
    )
    for ((index, triple) in codecs.withIndex()) {
        for (json in triple.second) tests.case("codec $index takes $json") { expect(null, fault(triple.first, json)) }
        for ((json, error) in triple.third) tests.case("codec $index refuses $json") { expect(error, fault(triple.first, json)) }
    }
    tests.case("a builder, its message and the way back") {
        val first = First.builder().a(5).note("secret").extra("x", Json.of("[1.50]")).build()
        expect("First(a=5, note=***, extra={x=[1.50]})", first.toString())
        expect("{\"a\":5,\"note\":\"secret\",\"x\":[1.50]}", first.toJson().text)
        expect(first, First.fromJson(first.toJson().text))
        expect(true, first != First.builder().a(6).build())
        expect("{\"a\":6,\"x\":[1.50]}", First.Builder(first).a(6).note(null).build().toJson().text)
    }
    tests.case("a builder without a required field") {
        expect(true, runCatching { First.builder().build() }.exceptionOrNull() is IllegalStateException)
    }
    tests.case("a list in a message is nobody else's") {
        val items = arrayListOf(1)
        val message = OneValue.of("l", Types.list(Types.I32)).let { type -> type.make(arrayOf(type.value.codec.kept(items)), Extra.NONE) }
        items.add(2)
        expect("{\"value\":[1]}", message.toJson().text)
    }
    tests.case("conditions") {
        expect("unasked", First.builder().a(5).onlyForOne(1).build().conditionError()?.kind?.name?.lowercase())
        expect("`onlyForOne` is missing: it is sent when `a` is 1 or 2", First.builder().a(1).build().conditionError()?.message)
        expect(null, First.builder().a(1).onlyForOne(7).checked().conditionError())
        expect(true, runCatching { First.builder().a(1).checked() }.exceptionOrNull() is ConditionError)
    }
    tests.case("an alias is read, and the key written") {
        expect("{\"a\":1}", First.fromJson("{\"A\":1}").toJson().text)
        expect("duplicate_key", errorOf { First.fromJson("{\"A\":1,\"a\":1}") })
    }
    tests.case("what is sent is checked") {
        expect("out_of_range", errorOf { OneValue.of("f", Types.F64).let { it.make(arrayOf(Double.NaN), Extra.NONE) }.check() })
        expect("lone_surrogate", errorOf { OneValue.of("s", Types.STRING).let { it.make(arrayOf("\uD800"), Extra.NONE) }.check() })
        expect("out_of_range", errorOf { OneValue.of("u", Types.U8).let { it.make(arrayOf(256), Extra.NONE) }.check() })
        expect("unknown_value", errorOf { OneValue.of("c", Closed).let { it.make(arrayOf(Closed.of("z")), Extra.NONE) }.check() })
    }
    tests.case("an error says where") {
        val type = OneValue.of("o", Types.list(OneValue.of("i", Types.list(Types.I8))))
        val error = runCatching { type.fromJson("{\"value\":[{\"value\":[1]},{\"value\":[1,1000]}]}") }.exceptionOrNull() as BodyError
        expect("value[1].value[1]", error.path)
    }
    tests.case("a broken body does not cost the envelope") {
        val read = Bodies.enveloped(Toy.responseEnvelope, EchoReply, "{\"result\":9,\"text\":1}".toByteArray(), Allowance.DEFAULT)
        expect(listOf("wrong_type", null, 9L), listOf(read.fault?.name, read.body, Envelopes.resultCode(Toy, read.envelope)))
    }
}

private class Mood private constructor(wire: Long) : IntValue(wire) {
    override val enumType: EnumType<*> get() = Mood

    companion object : IntEnumType<Mood>("Mood", Types.U8) {
        @JvmField
        val GLAD = named(1, "GLAD")

        override fun create(wire: Long): Mood = Mood(wire)
    }
}

private class Closed private constructor(wire: String) : TextValue(wire) {
    override val enumType: EnumType<*> get() = Closed

    companion object : TextEnumType<Closed>("Closed", isClosed = true) {
        @JvmField
        val A = named("a", "A")

        override fun create(wire: String): Closed = Closed(wire)
    }
}

private sealed interface Either {
    companion object : ChoiceType<Either>("Either") {
        override val forms: List<MessageType<*>> get() = listOf(First, Second)
    }
}

private class First private constructor(content: Content) : Message(content), Either {
    override val messageType: MessageType<First> get() = First
    val a: Int get() = get(A)

    class Builder(from: First?) : MessageBuilder<First, Builder>(First, from) {
        fun a(a: Int): Builder = put(A, a)

        fun note(note: String?): Builder = put(NOTE, note)

        fun onlyForOne(value: Int?): Builder = put(ONLY, value)
    }

    companion object : MessageType<First>("First") {
        private val A = required("a", Types.I32).also("A")
        private val NOTE = optional("note", Types.STRING).sensitive()
        private val ONLY = optional("onlyForOne", Types.I32).whenIs(A, 1, 2)

        fun builder(): Builder = Builder(null)

        override fun create(content: Content): First = First(content)
    }
}

private class Second private constructor(content: Content) : Message(content), Either {
    override val messageType: MessageType<Second> get() = Second

    companion object : MessageType<Second>("Second") {
        private val B = required("b", Types.I32)

        override fun create(content: Content): Second = Second(content)
    }
}
