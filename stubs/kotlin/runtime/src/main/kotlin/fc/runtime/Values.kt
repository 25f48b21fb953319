package fc.runtime

/** A JSON value, kept as its text: numbers have all their digits, and objects the order of their keys. */
public class Json private constructor(
    /** The text. */
    public val text: String,
) {
    override fun equals(other: Any?): Boolean = other is Json && other.text == text

    override fun hashCode(): Int = text.hashCode()

    override fun toString(): String = text

    public companion object {
        /** `null`. */
        @JvmField
        public val NULL: Json = Json("null")

        /**
         * The value that a text is.
         *
         * @throws BodyError if it is not JSON
         */
        @JvmStatic
        public fun of(text: String): Json {
            JsonReader(text, Allowance.DEFAULT).apply {
                skipValue()
                end()
            }
            return Json(text)
        }

        /** A text that a reader has seen to be JSON. */
        internal fun trusted(text: String): Json = Json(text)
    }
}

/**
 * The keys of a message that the spec does not have, in their order; kept unchanged and sent again. They are one text, in which
 * each question searches: many keys take no more memory than they had on the wire.
 */
public class Extra internal constructor(
    /** The keys and values as in an object, without its braces. */
    private val text: String,
) {
    /** Whether there is none. */
    public val isEmpty: Boolean get() = text.isEmpty()

    /** How many there are. */
    public val size: Int get() = keys.size

    /** The keys, in their order; one that came twice is there twice. */
    public val keys: List<String> get() = ArrayList<String>().also { keys -> each { key, _ -> keys.add(key) } }

    /** The last value of a key, or `null`. */
    public operator fun get(key: String): Json? {
        var last: String? = null
        each { other, value -> if (other == key) last = value }
        return last?.let { Json.trusted(it) }
    }

    private inline fun each(visit: (String, String) -> Unit) {
        val reader = JsonReader(text, Allowance.ANY)
        while (reader.peek() != JsonReader.END) {
            visit(reader.key(), reader.valueText())
            reader.take(",")
        }
    }

    internal fun plus(key: String, value: Json): Extra {
        val pair = JsonWriter().key(key).raw(value.text).text
        return Extra(if (isEmpty) pair else "$text,$pair")
    }

    internal fun write(writer: JsonWriter) {
        if (!isEmpty) writer.raw(text)
    }

    override fun equals(other: Any?): Boolean = other is Extra && other.text == text

    override fun hashCode(): Int = text.hashCode()

    override fun toString(): String {
        val pairs = ArrayList<String>()
        each { key, value -> pairs.add("$key=$value") }
        return pairs.joinToString(", ", "{", "}")
    }

    public companion object {
        /** No keys. */
        @JvmField
        public val NONE: Extra = Extra("")
    }
}

/** Bytes that travel as base64 text. */
public class Bytes private constructor(private val bytes: ByteArray) {
    /** How many there are. */
    public val size: Int get() = bytes.size

    /** One of them. */
    public operator fun get(index: Int): Byte = bytes[index]

    /** A copy of them. */
    public fun toByteArray(): ByteArray = bytes.copyOf()

    internal fun toBase64(): String = Base64.encode(bytes)

    override fun equals(other: Any?): Boolean = other is Bytes && other.bytes.contentEquals(bytes)

    override fun hashCode(): Int = bytes.contentHashCode()

    override fun toString(): String = "Bytes($size)"

    public companion object {
        /** No bytes. */
        @JvmField
        public val EMPTY: Bytes = Bytes(ByteArray(0))

        /** A copy of these. */
        @JvmStatic
        public fun of(bytes: ByteArray): Bytes = Bytes(bytes.copyOf())

        internal fun trusted(bytes: ByteArray): Bytes = Bytes(bytes)
    }
}

/**
 * Strict base64 with padding. That of the JDK is not in Android before 8.0, and takes a text without padding.
 */
internal object Base64 {
    private const val ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
    private val VALUES = IntArray(128) { ALPHABET.indexOf(it.toChar()) }

    fun encode(bytes: ByteArray): String {
        val out = StringBuilder((bytes.size + 2) / 3 * 4)
        var at = 0
        while (at < bytes.size) {
            val left = minOf(3, bytes.size - at)
            var group = 0
            for (index in 0 until 3) {
                group = group shl 8 or if (index < left) bytes[at + index].toInt() and 0xFF else 0
            }
            for (index in 0 until 4) {
                out.append(if (index <= left) ALPHABET[group shr (18 - 6 * index) and 0x3F] else '=')
            }
            at += 3
        }
        return out.toString()
    }

    /** The bytes, or `null` if it is not base64. */
    fun decode(text: String): ByteArray? {
        if (text.length % 4 != 0) return null
        val padding = if (text.endsWith("==")) 2 else if (text.endsWith("=")) 1 else 0
        val out = ByteArray(text.length / 4 * 3 - padding)
        var filled = 0
        var group = 0
        val digits = text.length - padding
        for (index in 0 until text.length) {
            val value = if (index < digits) value(text[index]) else 0
            if (value < 0) return null
            group = group shl 6 or value
            if (index % 4 != 3) continue
            for (shift in intArrayOf(16, 8, 0)) {
                val byte = group shr shift and 0xFF
                // What padding leaves over has to be zero, or two texts would be the same bytes.
                if (filled < out.size) out[filled++] = byte.toByte() else if (byte != 0) return null
            }
            group = 0
        }
        return out
    }

    private fun value(digit: Char): Int = if (digit.code < VALUES.size) VALUES[digit.code] else -1
}
