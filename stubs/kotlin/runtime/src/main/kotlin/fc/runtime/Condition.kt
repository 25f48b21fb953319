package fc.runtime

/** Under which values of the fields beside it a field is there. */
public class Condition internal constructor(private val isWhen: Boolean, internal val asked: List<Asked>) {
    internal class Asked(val field: AnyField, val values: List<Any>)

    internal fun holds(message: Message): Boolean = asked.all { it.field.isAmong(message, it.values) } == isWhen

    internal val isOnly: Boolean get() = isWhen

    override fun toString(): String = asked.joinToString(" and ", if (isWhen) "when " else "unless ") { asked ->
        val values = asked.values.joinToString(" or ") { if (it is String) "\"$it\"" else "$it" }
        "`${asked.field.key}` is $values"
    }
}

/** How a field contradicts its condition. */
public enum class ConditionErrorKind {
    /** It is not there although its condition holds. */
    MISSING,

    /** It is there although its condition does not hold. */
    UNASKED,
}

/** A message whose field contradicts its condition. */
public class ConditionError internal constructor(
    /** The key of the field. */
    public val key: String,
    /** Whether it is missing, or there without being asked for. */
    public val kind: ConditionErrorKind,
    /** What is asked. */
    public val condition: Condition,
) : Exception(null, null, false, false) {
    override val message: String
        get() = when (kind) {
            ConditionErrorKind.MISSING -> "`$key` is missing: it is sent $condition"
            ConditionErrorKind.UNASKED ->
                "`$key` is not asked for: it is sent ${if (condition.isOnly) "only " else ""}$condition"
        }
}
