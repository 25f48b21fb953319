package fc.runtime

/** Whom to send to. */
public class Audience private constructor(internal val connection: Long?) {
    public companion object {
        /** Every app connected at this moment. */
        @JvmField
        public val ALL: Audience = Audience(null)

        /** One app, by its command connection. For a stream also one data connection, by its own number. */
        @JvmStatic
        public fun one(connection: Long): Audience = Audience(connection)
    }
}

/** How a report ended at one app. */
public enum class AckOutcome {
    /** The app has acknowledged it. */
    ACKNOWLEDGED,

    /** The app has answered with another result than success. */
    REFUSED,

    /** The app has answered with something that is not an acknowledgement. */
    INVALID,

    /** No acknowledgement has come, and the report was repeated as often as it may be. */
    TIMED_OUT,

    /** The app was so slow that the report gave way to newer ones before it was sent. */
    DROPPED,

    /** The connection ended first. */
    CLOSED,
}

/** What has become of a report at one app. */
public class Acknowledgement internal constructor(
    /** The app. */
    public val connection: Long,
    /** How it ended. */
    public val outcome: AckOutcome,
    /** What the app has answered with, if it has refused. */
    public val refusal: Refusal?,
) {
    override fun toString(): String = "$connection: $outcome"
}

/** What can keep a report or stream from being queued. */
public enum class PushErrorKind(
    /** The fixed name. */
    public val text: String,
) {
    /** It breaks one of its own constraints. */
    INVALID("invalid_report"),

    /** It does not fit into a frame. */
    FRAME("frame"),

    /** There is no such connection any more; for a stream: no data connection of that app. */
    NO_CONNECTION("no_connection"),

    /** Several apps share an address, and nothing tells whose data connection is whose. */
    AMBIGUOUS("ambiguous"),
}

/** Why a report or stream was not even queued. */
public class PushError internal constructor(
    /** What went wrong. */
    public val kind: PushErrorKind,
    cause: Exception? = null,
) : Exception(if (cause == null) kind.text else "${kind.text}: ${cause.message}", cause) {
    /** The fixed name of what went wrong. */
    public val name: String get() = kind.text
}

/** A report waiting for one app, or in flight to it. */
internal class Queued(
    val code: Int,
    val policy: AckPolicy,
    val body: Prepared,
    val ended: (AckOutcome, Refusal?) -> Unit,
)
