package fc.runtime

/**
 * The id of an entity. Each entity has a class, so that the compiler keeps their ids apart. An id is sent as its
 * [value].
 */
public abstract class Id<V : Any>(
    /** The value: a string or a number. */
    public val value: V,
) {
    final override fun equals(other: Any?): Boolean = other is Id<*> && other.javaClass == javaClass && other.value == value

    final override fun hashCode(): Int = value.hashCode()

    final override fun toString(): String = value.toString()
}

/** Reads and writes an id as the value in it. */
internal class IdCodec<V : Any, I : Id<V>>(private val inner: Codec<V>, private val make: (V) -> I) : Codec<I>() {
    override val itemBytes: Int get() = inner.itemBytes

    override fun read(reader: JsonReader): I = make(inner.read(reader))

    override fun write(writer: JsonWriter, value: I): Unit = inner.write(writer, value.value)

    override fun check(value: I, isDeep: Boolean): Unit = inner.check(value.value, isDeep)

    override fun wire(value: I): Any = inner.wire(value.value)
}
