package fc.runtime

/** A call that has ended, for metrics. */
public class EndedCall internal constructor(
    /** Name of the command; `unknown` for all codes that the spec does not have. */
    public val operation: String,
    /**
     * The result. At the client it is `success`, the name of the [CallError], or `dropped` if the call was cancelled. At
     * the robot it is `success`, `protocol`, `timeout`, `invalid`, `expired` or `refused`.
     */
    public val result: String,
    /** Time: at the client from the call to its end, at the robot from the request to its response. */
    public val nanoseconds: Long,
) {
    override fun toString(): String = "EndedCall($operation, $result, $nanoseconds ns)"

    internal companion object {
        /** Returns the call of a code that began at [since], of [System.nanoTime]. */
        fun of(protocol: Protocol, code: Int, result: String, since: Long): EndedCall {
            val command = protocol.commands.firstOrNull { it.code == code }
            return EndedCall(command?.name ?: "unknown", result, System.nanoTime() - since)
        }
    }
}
