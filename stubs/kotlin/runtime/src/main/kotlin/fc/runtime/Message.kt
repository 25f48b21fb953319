package fc.runtime

/** The content of a message: the values of its fields, and the unknown keys. */
public class Content internal constructor(internal val values: Array<Any?>, internal val extra: Extra)

/** A JSON object with known keys. It is immutable; a builder creates a changed copy. */
public abstract class Message protected constructor(content: Content) {
    internal val values: Array<Any?> = content.values

    /** The unknown keys, kept unchanged and sent again. */
    public val extra: Extra = content.extra

    /** The type of this message. */
    public abstract val messageType: MessageType<*>

    /** Returns the value of a field. */
    @Suppress("UNCHECKED_CAST")
    protected operator fun <T : Any> get(field: Field<T>): T = values[field.index] as T

    /** Returns the value of an optional field, or `null`. */
    @Suppress("UNCHECKED_CAST")
    protected operator fun <T : Any> get(field: OptionalField<T>): T? = values[field.index] as T?

    /** Returns the message as JSON, without an envelope. */
    public fun toJson(): Json = Json.trusted(JsonWriter().also { messageType.writeObject(it, this) }.text)

    /**
     * Checks all constraints of the message and of everything inside. Messages are checked when they are sent, and
     * received ones have been checked.
     *
     * @throws BodyError the first broken constraint
     */
    @Throws(BodyError::class)
    public fun check(): Unit = messageType.checkAll(this)

    /** Returns the first field that is present although its condition does not hold, or missing although it does. */
    public fun conditionError(): ConditionError? = messageType.fields.asSequence().mapNotNull { it.contradiction(this) }.firstOrNull()

    override fun equals(other: Any?): Boolean =
        other is Message && other.messageType === messageType && other.values.contentEquals(values) && other.extra == extra

    override fun hashCode(): Int = values.contentHashCode() * 31 + extra.hashCode()

    override fun toString(): String = buildString {
        append(messageType.name).append('(')
        var isFirst = true
        for (field in messageType.fields) {
            val value = values[field.index] ?: continue
            if (!isFirst) append(", ")
            isFirst = false
            append(field.key).append('=').append(if (field.isSensitive) "***" else value)
        }
        if (!extra.isEmpty) append(if (isFirst) "" else ", ").append("extra=").append(extra)
        append(')')
    }
}

/** A key of a message. */
public abstract class AnyField internal constructor(
    /** Its key. */
    public val key: String,
    internal val index: Int,
    internal val isOptional: Boolean,
) {
    internal abstract val codec: Codec<*>
    internal var aliases: List<String> = emptyList()
    internal var isSensitive = false
    internal var isEmptyAbsent = false
    internal var role: EnvelopeRole? = null
    internal var condition: Condition? = null

    internal fun contradiction(message: Message): ConditionError? {
        val condition = condition ?: return null
        val isThere = message.values[index] != null
        if (condition.holds(message) == isThere) return null
        return ConditionError(key, if (isThere) ConditionErrorKind.UNASKED else ConditionErrorKind.MISSING, condition)
    }

    /** Returns `true` if the wire value is one of [wanted]. */
    internal fun isAmong(message: Message, wanted: List<Any>): Boolean {
        val value = message.values[index] ?: return false
        @Suppress("UNCHECKED_CAST")
        return (codec as Codec<Any>).wire(value) in wanted
    }
}

/** A required key of a message. */
public class Field<T : Any> internal constructor(key: String, index: Int, override val codec: Codec<T>) :
    AnyField(key, index, false) {
    /** Also accepts another key. */
    public fun also(key: String): Field<T> = apply { aliases += key }

    /** Hides the value in string forms. */
    public fun sensitive(): Field<T> = apply { isSensitive = true }

    /** Sets the role in an envelope. */
    public fun role(role: EnvelopeRole): Field<T> = apply { this.role = role }
}

/** An optional key of a message, which may be missing or `null`. */
public class OptionalField<T : Any> internal constructor(key: String, index: Int, override val codec: Codec<T>) :
    AnyField(key, index, true) {
    /** Also accepts another key. */
    public fun also(key: String): OptionalField<T> = apply { aliases += key }

    /** Hides the value in string forms. */
    public fun sensitive(): OptionalField<T> = apply { isSensitive = true }

    /** Quirk: reads `{}`, `[]` and `""` as a missing value. */
    public fun emptyIsAbsent(): OptionalField<T> = apply { isEmptyAbsent = true }

    /** Sets the role in an envelope. */
    public fun role(role: EnvelopeRole): OptionalField<T> = apply { this.role = role }

    /**
     * Makes the field present exactly if the wire value of [field] is one of [values]. Several conditions must all
     * hold.
     */
    public fun whenIs(field: AnyField, vararg values: Any): OptionalField<T> = conditional(true, field, values)

    /**
     * Makes the field absent exactly if the wire value of [field] is one of [values]. Several conditions must all hold.
     */
    public fun unlessIs(field: AnyField, vararg values: Any): OptionalField<T> = conditional(false, field, values)

    private fun conditional(isWhen: Boolean, field: AnyField, values: Array<out Any>): OptionalField<T> = apply {
        val asked = Condition.Asked(field, values.map { if (it is Int) it.toLong() else it })
        condition = Condition(isWhen, (condition?.asked ?: emptyList()) + asked)
    }
}

/** The role of a key of an envelope. */
public enum class EnvelopeRole {
    /** Creation time of the message. */
    TIME,

    /** The result code. */
    RESULT_CODE,

    /** The text of the result. */
    RESULT_TEXT,
}

/**
 * The type of a message with its fields. Its properties are created with [required] and [optional], in the order of
 * writing.
 */
public abstract class MessageType<M : Message> protected constructor(
    /** The name in the spec. */
    public val name: String,
    /** The example in the spec in wire form, without an envelope. */
    private val exampleJson: String = "{}",
) : Codec<M>() {
    private val all = ArrayList<AnyField>()
    private val byKey = HashMap<String, AnyField>()

    /** The fields. */
    public val fields: List<AnyField> get() = all

    override val itemBytes: Int get() = 40 + 8 * all.size

    /** Creates a message with this content. */
    protected abstract fun create(content: Content): M

    /** Adds a required key. */
    protected fun <T : Any> required(key: String, codec: Codec<T>): Field<T> = Field(key, all.size, codec).also { all.add(it) }

    /** Adds an optional key. */
    protected fun <T : Any> optional(key: String, codec: Codec<T>): OptionalField<T> =
        OptionalField(key, all.size, codec).also { all.add(it) }

    /** Returns the example in the spec. */
    public fun example(): M = Bodies.decode(this, exampleJson.toByteArray(), Allowance.ANY)

    /**
     * Reads a message from JSON without an envelope.
     *
     * @throws BodyError if it is not such a message
     */
    @Throws(BodyError::class)
    public fun fromJson(json: String): M = Bodies.decode(this, json.toByteArray(), Allowance.DEFAULT)

    internal fun make(values: Array<Any?>, extra: Extra): M = create(Content(values, extra))

    /** Returns the field with this key or alias. */
    internal fun field(key: String): AnyField? {
        if (byKey.isEmpty() && all.isNotEmpty()) index()
        return byKey[key]
    }

    // Runs on first use: a type adds the aliases after the field.
    private fun index() = synchronized(all) {
        val found = HashMap<String, AnyField>()
        for (field in all) for (key in field.aliases + field.key) found[key] = field
        byKey.putAll(found)
    }

    internal fun roleField(role: EnvelopeRole): AnyField? = all.firstOrNull { it.role == role }

    override fun read(reader: JsonReader): M {
        reader.peek()
        val start = reader.at
        val draft = Draft(this)
        reader.beginObject()
        while (!reader.endObject()) {
            val key = reader.key()
            if (!draft.take(reader, key)) draft.keep(reader, key)
            reader.endValue()
        }
        return draft.finish(reader, start)
    }

    override fun write(writer: JsonWriter, value: M): Unit = writeObject(writer, value)

    internal fun writeObject(writer: JsonWriter, message: Message) {
        writer.beginObject()
        writeFields(writer, message)
        writer.endObject()
    }

    @Suppress("UNCHECKED_CAST")
    internal fun writeFields(writer: JsonWriter, message: Message) {
        for (index in all.indices) {
            val value = message.values[index] ?: continue
            writer.key(all[index].key)
            (all[index].codec as Codec<Any>).write(writer, value)
        }
        message.extra.write(writer)
    }

    override fun check(value: M, isDeep: Boolean) {
        if (isDeep) checkAll(value)
    }

    /** Checks a message to be sent. Java can pass `null` and messages of other types. */
    internal fun demand(message: Any?): M {
        if (message !is Message || message.messageType !== this) {
            val found = (message as? Message)?.messageType?.name ?: message?.javaClass?.name
            throw BodyError(BodyErrorKind.WRONG_TYPE, "found ${if (found == null) "null" else "a `$found`"}; send a `$name`")
        }
        message.check()
        @Suppress("UNCHECKED_CAST")
        return message as M
    }

    internal fun checkAll(message: Message): Unit = checkFields(message.values, true)

    @Suppress("UNCHECKED_CAST")
    internal fun checkFields(values: Array<Any?>, isDeep: Boolean) {
        for (index in all.indices) {
            val value = values[index] ?: continue
            try {
                (all[index].codec as Codec<Any>).check(value, isDeep)
            } catch (error: BodyError) {
                throw error.inKey(all[index].key)
            }
        }
    }
}

/** A message that is being read. */
internal class Draft<M : Message>(private val type: MessageType<M>) {
    private val values = arrayOfNulls<Any?>(type.fields.size)
    private val come = BooleanArray(type.fields.size)
    private var kept: JsonWriter? = null

    /** Reads the value of a known key. Returns `false` for an unknown one. */
    fun take(reader: JsonReader, key: String): Boolean {
        val field = type.field(key) ?: return false
        if (come[field.index]) {
            reader.peek()
            throw reader.fault(BodyErrorKind.DUPLICATE_KEY, "the key came before; send it once").inKey(key)
        }
        come[field.index] = true
        reader.count(1)
        try {
            val isAbsent = field.isOptional && (reader.takeNull() || field.isEmptyAbsent && reader.takeEmpty())
            if (!isAbsent) values[field.index] = field.codec.read(reader)
        } catch (error: BodyError) {
            throw if (error.kind == BodyErrorKind.BAD_JSON) error else error.inKey(key)
        }
        return true
    }

    /** Keeps the value of an unknown key. */
    fun keep(reader: JsonReader, key: String) {
        reader.count(1)
        if (type === Empty) return reader.skipValue()
        (kept ?: JsonWriter().also { kept = it }).key(key).raw(reader.valueText())
    }

    /** Returns the message if it is complete and satisfies its constraints. */
    fun finish(reader: JsonReader, start: Int): M {
        val missing = type.fields.firstOrNull { !it.isOptional && values[it.index] == null }
        if (missing != null) {
            reader.at = start
            throw reader.fault(BodyErrorKind.MISSING_FIELD, "the required key is missing").inKey(missing.key)
        }
        try {
            type.checkFields(values, false)
        } catch (error: BodyError) {
            throw error.at(start)
        }
        return type.make(values, kept?.let { Extra(it.text) } ?: Extra.NONE)
    }
}

/** Collects the fields of a message. */
public abstract class MessageBuilder<M : Message, B : MessageBuilder<M, B>> protected constructor(
    private val type: MessageType<M>,
    from: M?,
) {
    private val values: Array<Any?> = from?.values?.copyOf() ?: arrayOfNulls(type.fields.size)
    private var extra: Extra = from?.extra ?: Extra.NONE

    /** Sets a field. */
    protected fun <T : Any> put(field: Field<T>, value: T): B = self { values[field.index] = field.codec.kept(value) }

    /** Sets an optional field; `null` removes it. */
    protected fun <T : Any> put(field: OptionalField<T>, value: T?): B =
        self { values[field.index] = value?.let { field.codec.kept(it) } }

    /** Adds an unknown key. */
    public fun extra(key: String, value: Json): B = self { extra = extra.plus(key, value) }

    /** Sets the unknown keys. */
    public fun extra(extra: Extra): B = self { this.extra = extra }

    @Suppress("UNCHECKED_CAST")
    private inline fun self(change: () -> Unit): B {
        change()
        return this as B
    }

    /**
     * Returns the message.
     *
     * @throws IllegalStateException if a required field is not set
     */
    public fun build(): M {
        val missing = type.fields.firstOrNull { !it.isOptional && values[it.index] == null }
        check(missing == null) { "${type.name} needs `${missing?.key}`" }
        return type.make(values.copyOf(), extra)
    }

    /**
     * Returns the message and checks its conditions.
     *
     * @throws ConditionError the first contradiction
     * @throws IllegalStateException if a required field is not set
     */
    @Throws(ConditionError::class)
    public fun checked(): M = build().also { message -> message.conditionError()?.let { throw it } }
}

/** A message without known keys; unknown ones are skipped. */
public class Empty private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<Empty> get() = Empty

    public companion object : MessageType<Empty>("Empty") {
        /** The only instance. */
        @JvmField
        public val INSTANCE: Empty = Empty(Content(emptyArray(), Extra.NONE))

        override fun create(content: Content): Empty = INSTANCE
    }
}
