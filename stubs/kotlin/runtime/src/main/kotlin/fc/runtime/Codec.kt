package fc.runtime

import java.util.Collections
import java.util.regex.Pattern

/**
 * Reads and writes values of a type, and checks their constraints.
 *
 * The codecs of plain types are in [Types]. A message, enum or choice is the codec of its type. Each method returns a
 * codec of the same type with another constraint or wire form.
 */
public abstract class Codec<T : Any> internal constructor() {
    /** Memory of an item in a list, in bytes (an estimate). */
    internal open val itemBytes: Int get() = 24

    /** Reads the next value. */
    internal abstract fun read(reader: JsonReader): T

    internal abstract fun write(writer: JsonWriter, value: T)

    /**
     * Checks the constraints of a value. With [isDeep], also of everything inside it.
     *
     * @throws BodyError if a constraint is broken
     */
    internal open fun check(value: T, isDeep: Boolean) {}

    /** Returns the value, or a copy if other code may change it. */
    internal open fun kept(value: T): T = value

    /** Returns the wire value, for comparison in conditions. */
    internal open fun wire(value: T): Any = value

    /** Returns the number, limited to the range of this type. */
    internal open fun nearest(number: Long): T = throw IllegalStateException("this type has no numbers")

    /** Reads the form inside a string. */
    internal open fun readQuoted(reader: JsonReader): T = throw IllegalStateException("this type is never quoted")

    internal open fun readLenient(reader: JsonReader): T = throw IllegalStateException("this type is never lenient")

    /** `wire: string`: a number or bool inside a JSON string. */
    public fun quoted(): Codec<T> = Quoted(this)

    /** `lenient`: also reads other common forms. */
    public fun lenient(): Codec<T> = Lenient(this)

    /** Sets the least value. */
    public fun min(limit: Number): Codec<T> = Bounded(this, limit, -1)

    /** Sets the largest value. */
    public fun max(limit: Number): Codec<T> = Bounded(this, limit, 1)

    /** Sets the least and largest number of characters, items or bytes. */
    @JvmOverloads
    public fun length(least: Int, most: Int = Int.MAX_VALUE): Codec<T> = Measured(this, least, most)

    /** Sets a regular expression that the whole string must match. */
    public fun pattern(pattern: String): Codec<T> = Patterned(this, pattern)

    /** Allows only these values of an enum, given as on the wire. */
    public fun only(vararg taken: Any): Codec<T> = Only(this, taken.map { if (it is Int) it.toLong() else it })
}

/** A codec that delegates to another one and changes a part. */
internal abstract class Wrapped<T : Any>(val inner: Codec<T>) : Codec<T>() {
    override val itemBytes: Int get() = inner.itemBytes

    override fun read(reader: JsonReader): T = inner.read(reader)

    override fun write(writer: JsonWriter, value: T): Unit = inner.write(writer, value)

    override fun check(value: T, isDeep: Boolean): Unit = inner.check(value, isDeep)

    override fun kept(value: T): T = inner.kept(value)

    override fun wire(value: T): Any = inner.wire(value)

    override fun readQuoted(reader: JsonReader): T = inner.readQuoted(reader)

    override fun readLenient(reader: JsonReader): T = inner.readLenient(reader)
}

private class Quoted<T : Any>(inner: Codec<T>) : Wrapped<T>(inner) {
    override fun read(reader: JsonReader): T = inner.readQuoted(reader)

    override fun write(writer: JsonWriter, value: T) {
        val text = JsonWriter().also { inner.write(it, value) }.text
        writer.string(text)
    }
}

private class Lenient<T : Any>(inner: Codec<T>) : Wrapped<T>(inner) {
    override fun read(reader: JsonReader): T = inner.readLenient(reader)
}

private class Bounded<T : Any>(inner: Codec<T>, private val limit: Number, private val side: Int) : Wrapped<T>(inner) {
    override fun check(value: T, isDeep: Boolean) {
        inner.check(value, isDeep)
        val order = compared(inner.wire(value) as Number, limit)
        if (order != 0 && order != side) return
        if (order == 0) return
        throw BodyError(BodyErrorKind.OUT_OF_RANGE, "the number must be at ${if (side < 0) "least" else "most"} $limit")
    }
}

/** Compares two numbers exactly. */
private fun compared(value: Number, limit: Number): Int {
    if ((value is Double || value is Float) && value.toDouble().isNaN()) return if (limit.toDouble() > 0) -1 else 1
    val isFraction = value is Double || value is Float || limit is Double || limit is Float
    if (isFraction) return value.toDouble().compareTo(limit.toDouble()).coerceIn(-1, 1)
    return integer(value).compareTo(integer(limit)).coerceIn(-1, 1)
}

private fun integer(value: Number): java.math.BigInteger =
    value as? java.math.BigInteger ?: java.math.BigInteger.valueOf(value.toLong())

private class Measured<T : Any>(inner: Codec<T>, private val least: Int, private val most: Int) : Wrapped<T>(inner) {
    override fun check(value: T, isDeep: Boolean) {
        inner.check(value, isDeep)
        val length = when (value) {
            is String -> value.codePointCount(0, value.length)
            is List<*> -> value.size
            is Bytes -> value.size
            else -> throw IllegalStateException("this type has no length")
        }
        if (length in least..most) return
        val wanted = if (least == most) "$least" else if (most == Int.MAX_VALUE) "at least $least" else "from $least to $most"
        throw BodyError(BodyErrorKind.BAD_LENGTH, "the length is $length; it must be $wanted")
    }
}

private class Patterned<T : Any>(inner: Codec<T>, private val source: String) : Wrapped<T>(inner) {
    private val pattern = Pattern.compile(source)

    override fun check(value: T, isDeep: Boolean) {
        inner.check(value, isDeep)
        val matches = try {
            pattern.matcher(value as String).matches()
        } catch (_: StackOverflowError) {
            // A text that overflows the stack of the regular expression does not match.
            false
        }
        if (!matches) throw BodyError(BodyErrorKind.BAD_PATTERN, "the string must match `$source` as a whole")
    }
}

private class Only<T : Any>(inner: Codec<T>, private val taken: List<Any>) : Wrapped<T>(inner) {
    override fun check(value: T, isDeep: Boolean) {
        inner.check(value, isDeep)
        if (inner.wire(value) in taken) return
        throw BodyError(BodyErrorKind.OUT_OF_RANGE, "the value must be one of: ${taken.joinToString(", ")}")
    }
}

/** A list of values. */
internal class ListCodec<T : Any>(private val item: Codec<T>) : Codec<List<T>>() {
    override fun read(reader: JsonReader): List<T> = items(reader) { item.read(reader) }

    override fun readQuoted(reader: JsonReader): List<T> = items(reader) { item.readQuoted(reader) }

    override fun readLenient(reader: JsonReader): List<T> = items(reader) { item.readLenient(reader) }

    private inline fun items(reader: JsonReader, read: () -> T): List<T> {
        var index = 0
        return reader.list(item.itemBytes) {
            try {
                read().also { index++ }
            } catch (error: BodyError) {
                throw if (error.kind == BodyErrorKind.BAD_JSON) error else error.inItem(index)
            }
        }
    }

    override fun write(writer: JsonWriter, value: List<T>) {
        writer.beginList()
        for (index in value.indices) item.write(writer, value[index])
        writer.endList()
    }

    override fun check(value: List<T>, isDeep: Boolean) {
        for (index in value.indices) {
            try {
                item.check(value[index], isDeep)
            } catch (error: BodyError) {
                throw error.inItem(index)
            }
        }
    }

    override fun kept(value: List<T>): List<T> = Collections.unmodifiableList(value.map(item::kept))
}
