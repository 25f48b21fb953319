package fc.runtime

/** The condition of a field: the values of other fields with which it is present. */
public class Condition internal constructor(private val isWhen: Boolean, internal val asked: List<Asked>) {
    internal class Asked(val field: AnyField, val values: List<Any>)

    internal fun holds(message: Message): Boolean = asked.all { it.field.isAmong(message, it.values) } == isWhen

    internal val isOnly: Boolean get() = isWhen

    override fun toString(): String = asked.joinToString(" and ", if (isWhen) "when " else "unless ") { asked ->
        val values = asked.values.joinToString(" or ") { if (it is String) "\"$it\"" else "$it" }
        "`${asked.field.key}` is $values"
    }
}

/** The kind of a contradiction between a field and its condition. */
public enum class ConditionErrorKind {
    /** The field is missing although its condition holds. */
    MISSING,

    /** The field is present although its condition does not hold. */
    UNASKED,
}

/** A field of a message contradicts its condition. */
public class ConditionError internal constructor(
    /** The key of the field. */
    public val key: String,
    /** The kind of the contradiction. */
    public val kind: ConditionErrorKind,
    /** The condition. */
    public val condition: Condition,
) : Exception(null, null, false, false) {
    override val message: String
        get() = when (kind) {
            ConditionErrorKind.MISSING -> "`$key` is missing: it is sent $condition"
            ConditionErrorKind.UNASKED ->
                "`$key` is not asked for: it is sent ${if (condition.isOnly) "only " else ""}$condition"
        }
}
