package fc.runtime

import java.math.BigInteger

/** The codecs of plain types. */
public object Types {
    /** A bool. */
    @JvmField
    public val BOOL: Codec<Boolean> = BoolCodec(isNumeric = false)

    /** A bool that is sent as 1 or 0. */
    @JvmField
    public val BOOL_AS_NUMBER: Codec<Boolean> = BoolCodec(isNumeric = true)

    /** An integer of 8 bits. */
    @JvmField
    public val I8: Codec<Int> = integer(-0x80, 0x7F) { it.toInt() }

    /** An integer of 16 bits. */
    @JvmField
    public val I16: Codec<Int> = integer(-0x8000, 0x7FFF) { it.toInt() }

    /** An integer of 32 bits. */
    @JvmField
    public val I32: Codec<Int> = integer(Int.MIN_VALUE.toLong(), Int.MAX_VALUE.toLong()) { it.toInt() }

    /** An integer of 64 bits; also a time, in milliseconds or seconds. */
    @JvmField
    public val I64: Codec<Long> = integer(Long.MIN_VALUE, Long.MAX_VALUE) { it.toLong() }

    /** An integer of 8 bits without a sign. */
    @JvmField
    public val U8: Codec<Int> = integer(0, 0xFF) { it.toInt() }

    /** An integer of 16 bits without a sign. */
    @JvmField
    public val U16: Codec<Int> = integer(0, 0xFFFF) { it.toInt() }

    /** An integer of 32 bits without a sign. */
    @JvmField
    public val U32: Codec<Long> = integer(0, 0xFFFF_FFFF) { it.toLong() }

    /** An integer of 64 bits without a sign. */
    @JvmField
    public val U64: Codec<BigInteger> = IntegerCodec(IntRangeOf(BigInteger.ZERO, MOST)) {
        it as? BigInteger ?: BigInteger.valueOf(it.toLong())
    }

    /** A floating-point number of 32 bits. */
    @JvmField
    public val F32: Codec<Float> = FloatCodec({ it.toFloat() }) { it.toDouble() }

    /** A floating-point number of 64 bits. */
    @JvmField
    public val F64: Codec<Double> = FloatCodec({ it.toDouble() }) { it }

    /** A string. */
    @JvmField
    public val STRING: Codec<String> = StringCodec

    /** Bytes as a base64 string. */
    @JvmField
    public val BASE64: Codec<Bytes> = Base64Codec

    /** Any JSON value. */
    @JvmField
    public val JSON: Codec<Json> = JsonCodec

    /** A list of [item]s. */
    @JvmStatic
    public fun <T : Any> list(item: Codec<T>): Codec<List<T>> = ListCodec(item)

    /** An id, made by [make] from a value. */
    @JvmStatic
    public fun <V : Any, I : Id<V>> id(value: Codec<V>, make: (V) -> I): Codec<I> = IdCodec(value, make)

    private val MOST get() = BigInteger.ONE.shiftLeft(Long.SIZE_BITS).subtract(BigInteger.ONE)

    private fun <T : Number> integer(min: Long, max: Long, make: (Number) -> T): Codec<T> =
        IntegerCodec(IntRangeOf(BigInteger.valueOf(min), BigInteger.valueOf(max)), make)
}

/** Reads a string whose complete content is a value, read by [parse]. */
private inline fun <T> JsonReader.quoted(wanted: String, parse: (JsonReader) -> T): T {
    if (peek() != '"') throw unexpected(wanted)
    val start = at
    val text = string()
    try {
        val inside = JsonReader(text, Allowance.NOTHING)
        val value = parse(inside)
        // A number in a string has no white space around it.
        if (inside.at == text.length && text.first() > ' ') return value
    } catch (error: BodyError) {
        at = start
        if (error.kind == BodyErrorKind.OUT_OF_RANGE && isNumber(text)) throw fault(error.kind, error.detail)
        throw fault(BodyErrorKind.WRONG_TYPE, "the string does not hold $wanted")
    }
    at = start
    throw fault(BodyErrorKind.WRONG_TYPE, "the string does not hold $wanted")
}

private val HEXADECIMAL = Regex("0[xX][0-9a-fA-F]+")

/** Returns `true` if the complete text is one number. */
private fun isNumber(text: String): Boolean = HEXADECIMAL.matches(text) ||
    JsonReader(text, Allowance.NOTHING).run { runCatching { number() }.isSuccess && at == text.length }

/** Returns the text as an integer if it starts with `0x`, or `null`. */
private fun JsonReader.hexadecimal(): BigInteger? {
    if (!HEXADECIMAL.matches(text)) return null
    at = text.length
    return BigInteger(text.substring(2), 16)
}

private class IntegerCodec<T : Number>(private val range: IntRangeOf, private val make: (Number) -> T) : Codec<T>() {
    override val itemBytes: Int get() = 8

    override fun read(reader: JsonReader): T = make(reader.integer(range))

    override fun readQuoted(reader: JsonReader): T = reader.quoted("an integer as a string") { read(it) }

    override fun readLenient(reader: JsonReader): T {
        if (reader.peek() != '"') return read(reader)
        return reader.quoted("an integer") { inside ->
            val value = inside.hexadecimal() ?: return@quoted read(inside)
            if (!range.has(value)) throw inside.outOfRange(range)
            make(value)
        }
    }

    override fun write(writer: JsonWriter, value: T) {
        writer.raw(value.toString())
    }

    override fun check(value: T, isDeep: Boolean) {
        if (value is BigInteger && range.has(value) || value !is BigInteger && range.has(value.toLong())) return
        throw BodyError(BodyErrorKind.OUT_OF_RANGE, "the number must be from ${range.min} to ${range.max}")
    }

    override fun wire(value: T): Any = if (value is Int) value.toLong() else value

    override fun nearest(number: Long): T = make(BigInteger.valueOf(number).max(range.min).min(range.max))
}

private class FloatCodec<T : Number>(private val parse: (String) -> T, private val double: (T) -> Double) : Codec<T>() {
    override val itemBytes: Int get() = 8

    override fun read(reader: JsonReader): T = reader.float(parse) { isFinite(it) }

    override fun readQuoted(reader: JsonReader): T = reader.quoted("a number as a string") { read(it) }

    override fun readLenient(reader: JsonReader): T {
        if (reader.peek() != '"') return read(reader)
        return reader.quoted("a number") { inside ->
            val value = inside.hexadecimal() ?: return@quoted read(inside)
            if (value.bitLength() > Long.SIZE_BITS) throw inside.fault(BodyErrorKind.OUT_OF_RANGE, "the number is too large")
            parse(value.toString())
        }
    }

    override fun write(writer: JsonWriter, value: T) {
        writer.raw(value.toString())
    }

    override fun check(value: T, isDeep: Boolean) {
        if (!isFinite(value)) throw BodyError(BodyErrorKind.OUT_OF_RANGE, "JSON has neither NaN nor infinities")
    }

    private fun isFinite(value: T): Boolean = double(value).let { !it.isNaN() && !it.isInfinite() }
}

private class BoolCodec(private val isNumeric: Boolean) : Codec<Boolean>() {
    override val itemBytes: Int get() = 4

    override fun read(reader: JsonReader): Boolean = if (isNumeric) zeroOrOne(reader, "0 or 1") else reader.bool()

    override fun readQuoted(reader: JsonReader): Boolean = reader.quoted("a bool as a string") { it.bool() }

    override fun readLenient(reader: JsonReader): Boolean = when (reader.peek()) {
        '"' -> reader.quoted("true or false") { it.bool() }
        '-', in '0'..'9' -> zeroOrOne(reader, "true, false, 0 or 1")
        else -> reader.bool()
    }

    private fun zeroOrOne(reader: JsonReader, wanted: String): Boolean {
        reader.peek()
        val start = reader.at
        val number = try {
            Types.U64.read(reader)
        } catch (_: BodyError) {
            null
        }
        if (number == BigInteger.ZERO) return false
        if (number == BigInteger.ONE) return true
        reader.at = start
        throw reader.unexpected(wanted)
    }

    override fun write(writer: JsonWriter, value: Boolean) {
        writer.raw(if (isNumeric) (if (value) "1" else "0") else value.toString())
    }
}

private object StringCodec : Codec<String>() {
    override val itemBytes: Int get() = 32

    override fun read(reader: JsonReader): String = reader.string()

    override fun write(writer: JsonWriter, value: String) {
        writer.string(value)
    }

    override fun check(value: String, isDeep: Boolean) {
        var index = 0
        while (index < value.length) {
            val character = value[index++]
            if (!character.isSurrogate()) continue
            if (!character.isHighSurrogate() || index == value.length || !value[index++].isLowSurrogate()) {
                throw BodyError(BodyErrorKind.LONE_SURROGATE, "half of a surrogate pair stands alone")
            }
        }
    }
}

private object Base64Codec : Codec<Bytes>() {
    override val itemBytes: Int get() = 32

    override fun read(reader: JsonReader): Bytes {
        reader.peek()
        val start = reader.at
        val bytes = Base64.decode(reader.string())
        if (bytes != null) return Bytes.trusted(bytes)
        reader.at = start
        throw reader.fault(BodyErrorKind.BAD_BASE64, "the string is not base64")
    }

    override fun write(writer: JsonWriter, value: Bytes) {
        writer.string(value.toBase64())
    }
}

private object JsonCodec : Codec<Json>() {
    override val itemBytes: Int get() = 32

    override fun read(reader: JsonReader): Json = Json.trusted(reader.valueText())

    override fun write(writer: JsonWriter, value: Json) {
        writer.raw(value.text)
    }
}
