package fc.runtime

/** A JSON value, kept as text: numbers keep all digits, and objects the order of their keys. */
public class Json private constructor(
    /** The JSON text. */
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
         * Parses a text.
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

        /** Wraps a text that is known to be JSON. */
        internal fun trusted(text: String): Json = Json(text)
    }
}

/**
 * The unknown keys of a message in order, kept unchanged and sent again. One string holds them all, and each query
 * searches it, so that they take no more memory than on the wire.
 */
public class Extra internal constructor(
    /** The keys and values as in an object, without its braces. */
    private val text: String,
) {
    /** `true` if there are no keys. */
    public val isEmpty: Boolean get() = text.isEmpty()

    /** The number of keys. */
    public val size: Int get() = keys.size

    /** The keys in order, including duplicates. */
    public val keys: List<String> get() = ArrayList<String>().also { keys -> each { key, _ -> keys.add(key) } }

    /** Returns the last value of a key, or `null`. */
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

/** Bytes that are sent as a base64 string. */
public class Bytes private constructor(private val bytes: ByteArray) {
    /** The number of bytes. */
    public val size: Int get() = bytes.size

    /** Returns one byte. */
    public operator fun get(index: Int): Byte = bytes[index]

    /** Returns a copy of the bytes. */
    public fun toByteArray(): ByteArray = bytes.copyOf()

    internal fun toBase64(): String = Base64.encode(bytes)

    override fun equals(other: Any?): Boolean = other is Bytes && other.bytes.contentEquals(bytes)

    override fun hashCode(): Int = bytes.contentHashCode()

    override fun toString(): String = "Bytes($size)"

    public companion object {
        /** No bytes. */
        @JvmField
        public val EMPTY: Bytes = Bytes(ByteArray(0))

        /** Copies the bytes. */
        @JvmStatic
        public fun of(bytes: ByteArray): Bytes = Bytes(bytes.copyOf())

        internal fun trusted(bytes: ByteArray): Bytes = Bytes(bytes)
    }
}

/** Strict base64 with padding. The JDK class is not in Android before 8.0, and accepts text without padding. */
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

    /** Returns the bytes, or `null` if the text is not base64. */
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
                // The unused bits must be zero, so that each byte array has exactly one encoding.
                if (filled < out.size) out[filled++] = byte.toByte() else if (byte != 0) return null
            }
            group = 0
        }
        return out
    }

    private fun value(digit: Char): Int = if (digit.code < VALUES.size) VALUES[digit.code] else -1
}
