package fc.runtime

/**
 * The type of a choice: an object of the first variant whose required keys are all present. Each variant is a message
 * that implements [C].
 */
public abstract class ChoiceType<C : Any> protected constructor(
    /** The name in the spec. */
    public val name: String,
) : Codec<C>() {
    /** The variants, in the order in which they are tried. */
    protected abstract val forms: List<MessageType<*>>

    override val itemBytes: Int get() = 64

    override fun read(reader: JsonReader): C {
        reader.peek()
        val present = reader.ahead { requiredKeys(reader) }
        val chosen = forms.firstOrNull { form ->
            form.fields.all { it.isOptional || it.key in present || it.aliases.any { alias -> alias in present } }
        }
        if (chosen == null) {
            val wanted = forms.joinToString(", or ") { form ->
                form.fields.filter { !it.isOptional }.joinToString(" and ") { "`${it.key}`" }
            }
            throw reader.fault(BodyErrorKind.NO_VARIANT, "send an object with the keys $wanted")
        }
        @Suppress("UNCHECKED_CAST")
        return chosen.read(reader) as C
    }

    /**
     * Returns the required keys of the variants that are present. Their number does not depend on the size of the
     * object.
     */
    private fun requiredKeys(reader: JsonReader): Set<String> {
        val present = HashSet<String>()
        reader.beginObject()
        while (!reader.endObject()) {
            val key = reader.key()
            if (forms.any { form -> form.field(key)?.isOptional == false }) present.add(key)
            reader.count(1)
            reader.skipValue()
            reader.endValue()
        }
        return present
    }

    override fun write(writer: JsonWriter, value: C) {
        val message = value as Message
        message.messageType.writeObject(writer, message)
    }

    override fun check(value: C, isDeep: Boolean) {
        if (isDeep) (value as Message).check()
    }
}
