package fc.runtime

/** The conditions under which the robot accepts a command. */
public class Preconditions internal constructor(
    /** `true` if it is accepted in any state. */
    public val isAnyState: Boolean,
    /**
     * The states that accept it: each of these enums must have one of these values. Empty if the spec does not specify
     * them.
     */
    public val states: List<Any>,
    /** Names of the commands that come first. */
    public val after: List<String>,
)

/** The time at which a report is sent. A path has wire keys from the body of the report on, joined by dots. */
public sealed class Cadence {
    /** At each change of the field at the path [field]. */
    public class OnChange(public val field: String) : Cadence()

    /** At each step of the number at the path [field]. [by] is the size of a step. */
    public class Step(public val field: String, public val by: Double) : Cadence()

    /** Every so many [milliseconds]. */
    public class Every(public val milliseconds: Long) : Cadence()

    /** At the latest so many [milliseconds] after a command that sets it off. */
    public class Within(public val milliseconds: Long) : Cadence()
}
