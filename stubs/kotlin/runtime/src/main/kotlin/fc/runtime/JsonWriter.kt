package fc.runtime

/** Writes JSON text without white space. */
internal class JsonWriter {
    private val out = StringBuilder(256)

    /** `true` if a comma must precede the next key or item. */
    private var isBehindValue = false

    val text: String get() = out.toString()

    fun beginObject(): JsonWriter = open('{')

    fun endObject(): JsonWriter = close('}')

    fun beginList(): JsonWriter = open('[')

    fun endList(): JsonWriter = close(']')

    fun key(key: String): JsonWriter {
        comma()
        quoted(key)
        out.append(':')
        isBehindValue = false
        return this
    }

    /** Appends a value that is JSON text. */
    fun raw(text: String): JsonWriter {
        comma()
        out.append(text)
        isBehindValue = true
        return this
    }

    fun string(text: String): JsonWriter {
        comma()
        quoted(text)
        isBehindValue = true
        return this
    }

    private fun open(bracket: Char): JsonWriter {
        comma()
        out.append(bracket)
        isBehindValue = false
        return this
    }

    private fun close(bracket: Char): JsonWriter {
        out.append(bracket)
        isBehindValue = true
        return this
    }

    private fun comma() {
        if (isBehindValue) out.append(',')
    }

    private fun quoted(text: String) {
        out.append('"')
        var start = 0
        for (index in text.indices) {
            val character = text[index]
            if (character >= ' ' && character != '"' && character != '\\') continue
            out.append(text, start, index)
            escape(character)
            start = index + 1
        }
        out.append(text, start, text.length).append('"')
    }

    private fun escape(character: Char) {
        out.append('\\')
        when (character) {
            '"', '\\' -> out.append(character)
            '\b' -> out.append('b')
            '\u000C' -> out.append('f')
            '\n' -> out.append('n')
            '\r' -> out.append('r')
            '\t' -> out.append('t')
            else -> {
                out.append("u00")
                out.append(HEX[character.code shr 4]).append(HEX[character.code and 0xF])
            }
        }
    }

    private companion object {
        const val HEX = "0123456789abcdef"
    }
}
