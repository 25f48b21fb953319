package fc.runtime

import java.math.BigInteger

/**
 * Reads JSON text (RFC 8259) by the expected type. Every method skips the white space in front of a value and stops
 * right after it.
 */
internal class JsonReader(val text: String, allowance: Allowance) {
    /** Number of characters read. */
    var at: Int = 0
    private var depth = allowance.depth
    private var values = allowance.values
    private val mostListBytes = allowance.listBytes
    private var listBytes = mostListBytes

    /** Memory of the lists read so far, in bytes (an estimate). */
    val spentListBytes: Long get() = mostListBytes - listBytes

    /** Skips white space and returns the next character, or [END] at the end. */
    fun peek(): Char {
        while (at < text.length) {
            val next = text[at]
            if (next > ' ') return next
            if (next != ' ' && next != '\n' && next != '\r' && next != '\t') return next
            at++
        }
        return END
    }

    private fun here(): Char = if (at < text.length) text[at] else END

    fun take(literal: String): Boolean {
        val found = text.startsWith(literal, at)
        if (found) at += literal.length
        return found
    }

    fun takeNull(): Boolean = peek() == 'n' && take("null")

    /** Reads `{}`, `[]` or `""` if it is the next value. */
    fun takeEmpty(): Boolean {
        val first = peek()
        val close = when (first) {
            '"' -> '"'
            '{' -> '}'
            '[' -> ']'
            else -> return false
        }
        val start = at++
        if (first != '"') peek()
        if (here() == close) {
            at++
            return true
        }
        at = start
        return false
    }

    /** Looks ahead, and restores the position afterwards. */
    fun <T> ahead(look: () -> T): T {
        val before = Place(at, depth, values, listBytes)
        val found = look()
        at = before.at
        depth = before.depth
        values = before.values
        listBytes = before.listBytes
        return found
    }

    private class Place(val at: Int, val depth: Int, val values: Int, val listBytes: Long)

    fun bool(): Boolean = when {
        peek() == 't' && take("true") -> true
        peek() == 'f' && take("false") -> false
        else -> throw unexpected("true or false")
    }

    /** Reads a value and returns its text. */
    fun valueText(): String {
        peek()
        val start = at
        skipValue()
        return text.substring(start, at)
    }

    /** Skips a value. */
    fun skipValue() {
        when (peek()) {
            '"' -> skipString()
            '{' -> {
                beginObject()
                while (!endObject()) {
                    skipString()
                    colon()
                    count(1)
                    skipValue()
                    endValue()
                }
            }
            '[' -> {
                beginList()
                if (endList()) return
                do {
                    count(1)
                    skipValue()
                } while (nextItem())
            }
            't' -> if (!take("true")) throw badJson("a JSON value is expected here")
            'f' -> if (!take("false")) throw badJson("a JSON value is expected here")
            'n' -> if (!take("null")) throw badJson("a JSON value is expected here")
            '-', in '0'..'9' -> number()
            else -> throw badJson("a JSON value is expected here")
        }
    }

    // Objects.

    /** Enters an object and stops at its first key or its closing brace. Returns the offset of the opening brace. */
    fun beginObject(): Int {
        if (peek() != '{') throw unexpected("an object")
        val start = at
        enter()
        val next = peek()
        if (next != '"' && next != '}') throw badJson("a key in quotes or `}` is expected here")
        return start
    }

    fun endObject(): Boolean {
        val ends = here() == '}'
        if (ends) leave()
        return ends
    }

    fun key(): String {
        val key = string()
        colon()
        return key
    }

    private fun colon() {
        if (peek() != ':') throw badJson("`:` is expected after a key")
        at++
    }

    /** Reads from the end of a value up to the next key or the closing brace. */
    fun endValue() {
        when (peek()) {
            ',' -> {
                at++
                if (peek() != '"') throw badJson("a key in quotes is expected after `,`")
            }
            '}' -> Unit
            else -> throw badJson("`,` or `}` is expected after a value")
        }
    }

    // Lists.

    fun beginList() {
        if (peek() != '[') throw unexpected("a list")
        enter()
    }

    /** Reads the closing bracket of an empty list. */
    fun endList(): Boolean {
        val ends = peek() == ']'
        if (ends) leave()
        return ends
    }

    /** Reads the separator after an item. Returns `true` if another item follows. */
    fun nextItem(): Boolean = when (peek()) {
        ',' -> {
            at++
            true
        }
        ']' -> {
            leave()
            false
        }
        else -> throw badJson("`,` or `]` is expected after an item")
    }

    /** Reads a list with about [itemBytes] bytes of memory per item. */
    inline fun <T> list(itemBytes: Int, read: () -> T): List<T> {
        beginList()
        if (endList()) return emptyList()
        val items = ArrayList<T>(4)
        do {
            spend(itemBytes)
            items.add(read())
            count(1)
        } while (nextItem())
        items.trimToSize()
        return java.util.Collections.unmodifiableList(items)
    }

    fun spend(bytes: Int) {
        listBytes -= bytes
        if (listBytes < 0) throw fault(BodyErrorKind.LISTS_TOO_LARGE, "the lists take more memory than the limit")
    }

    fun count(more: Int) {
        values -= more
        if (values < 0) throw fault(BodyErrorKind.TOO_MANY_VALUES, "more keys and items than the limit")
    }

    private fun enter() {
        if (depth == 0) throw fault(BodyErrorKind.TOO_DEEP, "nested deeper than the limit")
        depth--
        at++
    }

    private fun leave() {
        depth++
        at++
    }

    // Strings.

    fun string(): String {
        if (peek() != '"') throw unexpected("a string")
        val start = ++at
        plainRun()
        if (here() == '"') return text.substring(start, at++)
        val out = StringBuilder(text.length.coerceAtMost(at - start + 64)).append(text, start, at)
        while (true) {
            when (here()) {
                '"' -> {
                    at++
                    return out.toString()
                }
                '\\' -> escape(out)
                else -> throw brokenString()
            }
            val run = at
            plainRun()
            out.append(text, run, at)
        }
    }

    private fun plainRun() {
        var index = at
        while (index < text.length) {
            val character = text[index]
            if (character == '"' || character == '\\' || character < ' ') break
            index++
        }
        at = index
    }

    private fun escape(out: StringBuilder) {
        val start = at
        when (val letter = escapeLetter()) {
            'b' -> out.append('\b')
            'f' -> out.append('\u000C')
            'n' -> out.append('\n')
            'r' -> out.append('\r')
            't' -> out.append('\t')
            'u' -> {
                val first = hex4()
                out.append(first)
                if (first.isHighSurrogate() && take("\\u")) {
                    val second = hex4()
                    if (!second.isLowSurrogate()) throw loneSurrogate(start)
                    out.append(second)
                } else if (first.isSurrogate()) {
                    throw loneSurrogate(start)
                }
            }
            else -> out.append(letter)
        }
    }

    private fun escapeLetter(): Char {
        at++
        val letter = here()
        if (letter !in "\"\\/bfnrtu" || at >= text.length) {
            throw badJson("one of `\"\\/bfnrtu` is expected after a backslash")
        }
        at++
        return letter
    }

    private fun hex4(): Char {
        var value = 0
        repeat(4) {
            val digit = if (here() < '\u0080') Character.digit(here(), 16) else -1
            if (digit < 0) throw badJson("four hexadecimal digits are expected after `\\u`")
            value = value shl 4 or digit
            at++
        }
        return value.toChar()
    }

    private fun skipString() {
        if (peek() != '"') throw unexpected("a string")
        at++
        while (true) {
            plainRun()
            when (here()) {
                '"' -> {
                    at++
                    return
                }
                '\\' -> if (escapeLetter() == 'u') hex4()
                else -> throw brokenString()
            }
        }
    }

    private fun brokenString(): BodyError =
        badJson(if (at < text.length) "a control character must be escaped" else "a closing quote is expected")

    private fun loneSurrogate(start: Int): BodyError {
        at = start
        return fault(BodyErrorKind.LONE_SURROGATE, "half of a surrogate pair stands alone; send whole characters")
    }

    // Numbers.

    /** Reads a number and returns its text. */
    fun number(): String {
        val start = at
        if (here() == '-') at++
        val whole = at
        digits()
        if (at - whole > 1 && text[whole] == '0') {
            at = whole
            throw badJson("a number must not start with `0`")
        }
        if (here() == '.') {
            at++
            digits()
        }
        if (here() == 'e' || here() == 'E') {
            at++
            if (here() == '+' || here() == '-') at++
            digits()
        }
        return text.substring(start, at)
    }

    private fun digits() {
        val start = at
        while (at < text.length && text[at] in '0'..'9') at++
        if (at == start) throw badJson("a digit is expected here")
    }

    /** Reads an integer in any notation, exactly: `1.0` and `1e2` are integers. */
    fun integer(range: IntRangeOf): Number {
        val first = peek()
        if (first != '-' && first !in '0'..'9') throw unexpected("an integer")
        val start = at
        val written = number()
        if (written.length <= SAFE_LENGTH && written.all { it in '0'..'9' || it == '-' }) {
            val value = written.toLong()
            if (range.has(value)) return value
            at = start
            throw outOfRange(range)
        }
        val value = amount(written)
        if (value == null) {
            at = start
            throw fault(BodyErrorKind.WRONG_TYPE, "found a number that is not integral; send an integer")
        }
        if (!range.has(value)) {
            at = start
            throw outOfRange(range)
        }
        return value
    }

    fun outOfRange(range: IntRangeOf): BodyError =
        fault(BodyErrorKind.OUT_OF_RANGE, "the number must be from ${range.min} to ${range.max}")

    /** Reads a floating-point number. [parse] converts its text. */
    inline fun <T> float(parse: (String) -> T, isFinite: (T) -> Boolean): T {
        val first = peek()
        if (first != '-' && first !in '0'..'9') throw unexpected("a number")
        val start = at
        val value = parse(number())
        if (!isFinite(value)) {
            at = start
            throw fault(BodyErrorKind.OUT_OF_RANGE, "the number is too large for the floating-point type of the field")
        }
        return value
    }

    /** Checks that only white space is left. */
    fun end() {
        peek()
        if (at < text.length) throw badJson("nothing may follow the value")
    }

    // Errors.

    fun fault(kind: BodyErrorKind, detail: String): BodyError = BodyError(kind, detail, "", at)

    fun badJson(detail: String): BodyError =
        fault(BodyErrorKind.BAD_JSON, if (at >= text.length) "$detail; the text ends" else detail)

    fun unexpected(wanted: String): BodyError {
        val found = when (peek()) {
            '"' -> "a string"
            '{' -> "an object"
            '[' -> "a list"
            't', 'f' -> "a bool"
            'n' -> "null"
            '-', in '0'..'9' -> "a number"
            else -> if (at >= text.length) "the end of the text" else "no JSON value"
        }
        return fault(BodyErrorKind.WRONG_TYPE, "found $found; send $wanted")
    }

    internal companion object {
        /** The character after the last. Since it is not valid JSON, a text that contains it fails there. */
        const val END: Char = '\u0000'

        /** Any integer with this many characters fits into 64 bits. */
        private const val SAFE_LENGTH = 18

        /** More digits than any integer type has. */
        private const val MANY_DIGITS = 40L

        /**
         * Returns the integer value of a number, or `null` for a fraction. A value far out of range remains far out of
         * range.
         */
        fun amount(number: String): BigInteger? {
            val negative = number.startsWith("-")
            val mark = number.indexOfFirst { it == 'e' || it == 'E' }
            val mantissa = number.substring(if (negative) 1 else 0, if (mark < 0) number.length else mark)
            val exponent = if (mark < 0) 0 else exponent(number.substring(mark + 1))
            val point = mantissa.indexOf('.')
            val decimals = if (point < 0) 0 else mantissa.length - point - 1
            val all = mantissa.replace(".", "").trimStart('0')
            if (all.isEmpty()) return BigInteger.ZERO
            val digits = all.trimEnd('0')
            val power = exponent - decimals + (all.length - digits.length)
            if (power < 0) return null
            val value = if (digits.length + power > MANY_DIGITS) {
                BigInteger.TEN.pow(MANY_DIGITS.toInt())
            } else {
                BigInteger(digits).multiply(BigInteger.TEN.pow(power.toInt()))
            }
            return if (negative) value.negate() else value
        }

        /** Returns an exponent, limited to ±[FAR]. */
        private fun exponent(text: String): Long {
            val far = if (text.startsWith("-")) -FAR else FAR
            return text.removePrefix("+").toLongOrNull()?.coerceIn(-FAR, FAR) ?: far
        }

        /** Longer than any text. */
        private const val FAR = 1L shl 40
    }
}

/** The range of an integer type. */
internal class IntRangeOf(val min: BigInteger, val max: BigInteger) {
    private val least = min.toLong()

    /** The maximum, limited to 63 bits: for a `u64`, every positive `Long` is in range. */
    private val most = if (max.bitLength() < Long.SIZE_BITS) max.toLong() else Long.MAX_VALUE

    fun has(value: Long): Boolean = value in least..most

    fun has(value: BigInteger): Boolean = value in min..max
}
