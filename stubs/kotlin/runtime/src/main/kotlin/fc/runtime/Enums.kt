package fc.runtime

/** A value of an enum that is sent as an integer. An open enum keeps values that the spec does not define. */
public abstract class IntValue protected constructor(
    /** The value on the wire. A `u64` has the same bits in the `Long`. */
    public val wire: Long,
) {
    /** The type of this value. */
    protected abstract val enumType: EnumType<*>

    /** The name in the spec; `null` if the spec does not define the value. */
    public val name: String? get() = enumType.nameOf(wire)

    /** `true` if the spec defines the value. */
    public val isKnown: Boolean get() = name != null

    override fun equals(other: Any?): Boolean = other is IntValue && other.enumType === enumType && other.wire == wire

    override fun hashCode(): Int = wire.hashCode()

    override fun toString(): String = name ?: "${enumType.name}($wire)"
}

/** A value of an enum that is sent as a string. See [IntValue]. */
public abstract class TextValue protected constructor(
    /** The value on the wire. */
    public val wire: String,
) {
    /** The type of this value. */
    protected abstract val enumType: EnumType<*>

    /** The name in the spec; `null` if the spec does not define the value. */
    public val name: String? get() = enumType.nameOf(wire)

    /** `true` if the spec defines the value. */
    public val isKnown: Boolean get() = name != null

    override fun equals(other: Any?): Boolean = other is TextValue && other.enumType === enumType && other.wire == wire

    override fun hashCode(): Int = wire.hashCode()

    override fun toString(): String = name ?: "${enumType.name}(\"$wire\")"
}

/** The type of an enum, with the values in the spec. */
public abstract class EnumType<E : Any> internal constructor(
    /** The name in the spec. */
    public val name: String,
    private val isClosed: Boolean,
) : Codec<E>() {
    private val named = LinkedHashMap<Any, Pair<String, E>>()

    /** All values in the spec, in order. */
    public val values: List<E> get() = named.values.map { it.second }

    internal fun nameOf(wire: Any): String? = named[wire]?.first

    internal fun add(wire: Any, name: String, value: E): E = value.also { named[wire] = name to value }

    internal fun known(wire: Any): E? = named[wire]?.second

    /** Returns the value with this wire form. A closed enum refuses unknown values. */
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

/** The type of an enum that is sent as an integer of [kind]. */
public abstract class IntEnumType<E : IntValue> protected constructor(
    name: String,
    private val kind: Codec<out Number>,
    isClosed: Boolean = false,
) : EnumType<E>(name, isClosed) {
    override val itemBytes: Int get() = 8

    /** Creates a value, which may be unknown. */
    protected abstract fun create(wire: Long): E

    /** Adds a value of the spec. */
    protected fun named(wire: Long, name: String): E = add(wire, name, create(wire))

    /** Returns the value with this wire form. */
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
        writer.raw(if (isUnsigned) java.lang.Long.toUnsignedString(value.wire) else value.wire.toString())
    }

    @Suppress("UNCHECKED_CAST")
    override fun check(value: E, isDeep: Boolean) {
        // Every `Long` is a valid `u64`.
        if (!isUnsigned) (kind as Codec<Number>).check(value.wire, isDeep)
        checkClosed(value.wire)
    }

    private val isUnsigned: Boolean get() = kind === Types.U64

    override fun wire(value: E): Any = value.wire
}

/** The type of an enum that is sent as a string. */
public abstract class TextEnumType<E : TextValue> protected constructor(
    name: String,
    isClosed: Boolean = false,
) : EnumType<E>(name, isClosed) {
    override val itemBytes: Int get() = 32

    /** Creates a value, which may be unknown. */
    protected abstract fun create(wire: String): E

    /** Adds a value of the spec. */
    protected fun named(wire: String, name: String): E = add(wire, name, create(wire))

    /** Returns the value with this wire form. */
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

/** A state of a process. */
public interface State {
    /** `true` for a final state. */
    public val isFinal: Boolean

    /** `true` for a failure. */
    public val isError: Boolean

    /**
     * Returns `true` if the spec allows this state after [previous]. Without a rule, every state is allowed. The same state
     * and a failure are always allowed.
     */
    public fun mayFollow(previous: State): Boolean
}

/** The meaning of the order of an enum's values. */
public enum class StateOrder {
    /** The spec has no order. */
    UNSAID,

    /** The normal order. Other changes may occur as well. */
    NORMAL,

    /** All changes: no other change occurs. */
    COMPLETE,
}

/** The values of an enum as states of a process, by the value that is sent. */
public class Steps(private val type: EnumType<*>, private val order: StateOrder) {
    private val next = HashMap<Any, List<Any>>()
    private var finals: List<Any> = emptyList()
    private var errors: List<Any> = emptyList()

    /** Adds the successors of [wire]. */
    public fun then(wire: Any, vararg next: Any): Steps = apply { this.next[wire] = next.toList() }

    /** Marks final states. */
    public fun finals(vararg wires: Any): Steps = apply { finals = wires.toList() }

    /** Marks failures. */
    public fun errors(vararg wires: Any): Steps = apply { errors = wires.toList() }

    /** Returns `true` for a final state. */
    public fun isFinal(wire: Any): Boolean = wire in finals

    /** Returns `true` for a failure. */
    public fun isError(wire: Any): Boolean = wire in errors

    /** Returns `true` if the spec allows [wire] after [previous]. */
    public fun mayFollow(previous: Any, wire: Any): Boolean {
        if (wire == previous || isError(wire) || order == StateOrder.UNSAID) return true
        // A value that is not in the spec may follow and precede any value.
        if (type.known(previous) == null || type.known(wire) == null) return true
        val named = next[previous]
        if (named == null && order == StateOrder.NORMAL && !isFinal(previous)) return true
        return named != null && wire in named
    }
}

/** Returns `true` unless both values are present and differ. */
public fun sameOrUnsaid(one: Any?, other: Any?): Boolean = one == null || other == null || one == other
