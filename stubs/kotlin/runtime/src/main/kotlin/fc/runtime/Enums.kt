package fc.runtime

/**
 * A value of an enum that travels as an integer. An open enum also has values that the spec does not name: they are kept as
 * they came.
 */
public abstract class IntValue protected constructor(
    /** What travels. */
    public val wire: Long,
) {
    /** The type of this value. */
    protected abstract val enumType: EnumType<*>

    /** Its name in the spec; `null` if the spec does not know it. */
    public val name: String? get() = enumType.nameOf(wire)

    /** Whether the spec knows it. */
    public val isKnown: Boolean get() = name != null

    override fun equals(other: Any?): Boolean = other is IntValue && other.enumType === enumType && other.wire == wire

    override fun hashCode(): Int = wire.hashCode()

    override fun toString(): String = name ?: "${enumType.name}($wire)"
}

/** A value of an enum that travels as a text, as [IntValue] is one of an integer. */
public abstract class TextValue protected constructor(
    /** What travels. */
    public val wire: String,
) {
    /** The type of this value. */
    protected abstract val enumType: EnumType<*>

    /** Its name in the spec; `null` if the spec does not know it. */
    public val name: String? get() = enumType.nameOf(wire)

    /** Whether the spec knows it. */
    public val isKnown: Boolean get() = name != null

    override fun equals(other: Any?): Boolean = other is TextValue && other.enumType === enumType && other.wire == wire

    override fun hashCode(): Int = wire.hashCode()

    override fun toString(): String = name ?: "${enumType.name}(\"$wire\")"
}

/** The type of an enum: the values that the spec names. */
public abstract class EnumType<E : Any> internal constructor(
    /** Its name. */
    public val name: String,
    private val isClosed: Boolean,
) : Codec<E>() {
    private val named = LinkedHashMap<Any, Pair<String, E>>()

    /** All values that the spec names, in its order. */
    public val values: List<E> get() = named.values.map { it.second }

    internal fun nameOf(wire: Any): String? = named[wire]?.first

    internal fun add(wire: Any, name: String, value: E): E = value.also { named[wire] = name to value }

    internal fun known(wire: Any): E? = named[wire]?.second

    /** The value that travels so; of a closed enum only one that the spec names. */
    internal inline fun taken(reader: JsonReader, start: Int, wire: Any, make: () -> E): E {
        known(wire)?.let { return it }
        if (!isClosed) return make()
        reader.at = start
        throw reader.fault(BodyErrorKind.UNKNOWN_VALUE, "`${shortened("$wire")}` is none of the values of this field")
    }

    internal fun checkClosed(wire: Any) {
        if (!isClosed || known(wire) != null) return
        throw BodyError(BodyErrorKind.UNKNOWN_VALUE, "`${shortened("$wire")}` is none of the values of this field")
    }
}

/** The type of an enum that travels as an integer of [kind]. */
public abstract class IntEnumType<E : IntValue> protected constructor(
    name: String,
    private val kind: Codec<out Number>,
    isClosed: Boolean = false,
) : EnumType<E>(name, isClosed) {
    override val itemBytes: Int get() = 8

    /** A value that the spec may not know. */
    protected abstract fun create(wire: Long): E

    /** A value that the spec names. */
    protected fun named(wire: Long, name: String): E = add(wire, name, create(wire))

    /** The value that travels so. */
    public open fun of(wire: Long): E = known(wire) ?: create(wire)

    override fun read(reader: JsonReader): E = reading(reader) { kind.read(reader) }

    override fun readQuoted(reader: JsonReader): E = reading(reader) { kind.readQuoted(reader) }

    override fun readLenient(reader: JsonReader): E = reading(reader) { kind.readLenient(reader) }

    private inline fun reading(reader: JsonReader, read: () -> Number): E {
        reader.peek()
        val start = reader.at
        val wire = read().toLong()
        return taken(reader, start, wire) { create(wire) }
    }

    override fun write(writer: JsonWriter, value: E) {
        writer.raw(value.wire.toString())
    }

    @Suppress("UNCHECKED_CAST")
    override fun check(value: E, isDeep: Boolean) {
        (kind as Codec<Number>).check(value.wire, isDeep)
        checkClosed(value.wire)
    }

    override fun wire(value: E): Any = value.wire
}

/** The type of an enum that travels as a text. */
public abstract class TextEnumType<E : TextValue> protected constructor(
    name: String,
    isClosed: Boolean = false,
) : EnumType<E>(name, isClosed) {
    override val itemBytes: Int get() = 32

    /** A value that the spec may not know. */
    protected abstract fun create(wire: String): E

    /** A value that the spec names. */
    protected fun named(wire: String, name: String): E = add(wire, name, create(wire))

    /** The value that travels so. */
    public open fun of(wire: String): E = known(wire) ?: create(wire)

    override fun read(reader: JsonReader): E {
        reader.peek()
        val start = reader.at
        val wire = reader.string()
        return taken(reader, start, wire) { create(wire) }
    }

    override fun write(writer: JsonWriter, value: E) {
        writer.string(value.wire)
    }

    override fun check(value: E, isDeep: Boolean) {
        Types.STRING.check(value.wire, isDeep)
        checkClosed(value.wire)
    }

    override fun wire(value: E): Any = value.wire
}

/** A value that says how far a process has come. */
public interface State {
    /** Whether nothing follows it. */
    public val isFinal: Boolean

    /** Whether it says that something failed. */
    public val isError: Boolean

    /**
     * Whether it may come after [previous]: false only if the spec says what does, and it is not that. The same state again
     * and a failure are in order.
     */
    public fun mayFollow(previous: State): Boolean
}

/** What the order of an enum's values claims. */
public enum class StateOrder {
    /** Nothing is said of it. */
    UNSAID,

    /** The order in which they normally follow each other; any other change may occur as well. */
    NORMAL,

    /** Every change there is: no other value follows. */
    COMPLETE,
}

/** What the spec says of the values of an enum as states of a process, by what travels. */
public class Steps(private val type: EnumType<*>, private val order: StateOrder) {
    private val next = HashMap<Any, List<Any>>()
    private var finals: List<Any> = emptyList()
    private var errors: List<Any> = emptyList()

    /** After [wire] come these. */
    public fun then(wire: Any, vararg next: Any): Steps = apply { this.next[wire] = next.toList() }

    /** Nothing follows these. */
    public fun finals(vararg wires: Any): Steps = apply { finals = wires.toList() }

    /** These say that something failed. */
    public fun errors(vararg wires: Any): Steps = apply { errors = wires.toList() }

    /** Whether nothing follows it. */
    public fun isFinal(wire: Any): Boolean = wire in finals

    /** Whether it says that something failed. */
    public fun isError(wire: Any): Boolean = wire in errors

    /** Whether it may come after [previous]. */
    public fun mayFollow(previous: Any, wire: Any): Boolean {
        if (wire == previous || isError(wire) || order == StateOrder.UNSAID) return true
        // Nothing is known of a value that the spec does not have.
        if (type.known(previous) == null || type.known(wire) == null) return true
        val named = next[previous]
        if (named == null && order == StateOrder.NORMAL && !isFinal(previous)) return true
        return named != null && wire in named
    }
}

/** Whether two values are the same, or one of them is not said: what is not said tells nothing apart. */
public fun sameOrUnsaid(one: Any?, other: Any?): Boolean = one == null || other == null || one == other
