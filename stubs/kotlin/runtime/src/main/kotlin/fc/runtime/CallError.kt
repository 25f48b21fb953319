package fc.runtime

/** The kind of a failed call. All implementations of the protocol share the names. */
public enum class CallErrorKind(
    /** The fixed name. */
    public val text: String,
) {
    /** The robot responded with a result other than success. */
    REFUSED("refused"),

    /** No response in time over an intact connection. The robot may have acted. */
    TIMEOUT("timeout"),

    /** No connection in time; the call has not been sent. */
    NOT_CONNECTED("not_connected"),

    /** The connection is closed for good; the call has not been sent. */
    CLOSED("closed"),

    /** The connection was lost during the call. The robot may have acted. */
    LOST("lost"),

    /** Too many calls are in flight; the call has not been sent. */
    BUSY("busy"),

    /** The request breaks one of its constraints; it has not been sent. */
    INVALID_REQUEST("invalid_request"),

    /** The body is not a response to this command. */
    INVALID_RESPONSE("invalid_response"),

    /** The request does not fit into a frame, or the response frame is broken. */
    FRAME("frame"),
}

/** The error of a failed call. */
public class CallError internal constructor(
    /** The kind of the error. */
    public val kind: CallErrorKind,
    /** The reason of the loss, if it ended the call. */
    public val loss: Loss? = null,
    cause: Exception? = null,
    private val declared: List<DeclaredError> = emptyList(),
) : Exception(null, cause) {
    /** The fixed name of the error. Its cause, a [BodyError] or [FrameError], has another name. */
    public val name: String get() = kind.text

    /** The refusal of the robot, if any. */
    public val refusal: Refusal? get() = cause as? Refusal

    /** Returns the declared error of the command that the robot responded with, or `null`. */
    public fun declared(): DeclaredError? = refusal?.let { refusal -> declared.firstOrNull { it.code == refusal.code } }

    override val message: String
        get() = when (kind) {
            CallErrorKind.REFUSED -> refusal?.message ?: name
            CallErrorKind.TIMEOUT -> "no response in time"
            CallErrorKind.NOT_CONNECTED -> "not sent, for there was no connection in time: $loss"
            CallErrorKind.CLOSED -> "not sent, for the connection is closed: $loss; connect again"
            CallErrorKind.LOST -> "the connection was lost before the response arrived: $loss; query the robot's state"
            CallErrorKind.BUSY -> "too many calls are in flight; wait for one, or raise the limit"
            CallErrorKind.INVALID_REQUEST -> "the request is invalid: ${cause?.message}"
            CallErrorKind.INVALID_RESPONSE -> "the response is invalid: ${cause?.message}"
            CallErrorKind.FRAME -> cause?.message ?: name
        }
}

/** The reason why a connection was lost or is not available. */
public class Loss internal constructor(
    /** The fixed name of the reason. For invalid bytes from the robot, the name of the [FrameError]. */
    public val name: String,
    private val text: String,
    /** The error of the network or of the frame. */
    public val cause: Exception? = null,
) {
    override fun equals(other: Any?): Boolean = other is Loss && other.name == name && other.text == text

    override fun hashCode(): Int = name.hashCode()

    override fun toString(): String = if (cause == null) text else "$text: ${cause.message ?: cause.javaClass.simpleName}"

    internal companion object {
        val NOT_YET = Loss("not_yet", "the first connection is still being made")
        val CLOSED = Loss("closed_by_robot", "the robot has closed the connection")
        val UNHEARD = Loss(
            "closed_unheard",
            "the robot has closed the connection before it sent anything; it may have too many connections",
        )
        val UNREAD = Loss("unread", "the robot does not read")
        val CONNECT_TIMEOUT = Loss("connect_timeout", "cannot connect in time")
        val RENEWED = Loss("renewed", "the command connection was made again, and the data connection with it")
        val HERE = Loss("closed_here", "the connection was closed by this side")

        fun broken(cause: Exception) = Loss("broken", "the connection broke", cause)

        fun unreachable(cause: Exception) = Loss("unreachable", "cannot connect", cause)

        fun frame(error: FrameError) = Loss(error.name, "the robot's bytes are no frames", error)

        fun stalled(received: Int, total: Long) =
            Loss("stalled", "a frame stalled: $received bytes have come of $total; is its length right?")
    }
}
