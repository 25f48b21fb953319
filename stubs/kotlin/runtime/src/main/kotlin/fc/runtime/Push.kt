package fc.runtime

/** The receivers of a report or stream. */
public class Audience private constructor(internal val connection: Long?) {
    public companion object {
        /** All connected apps. */
        @JvmField
        public val ALL: Audience = Audience(null)

        /** One app, by its command connection. For a stream also one data connection, by its number. */
        @JvmStatic
        public fun one(connection: Long): Audience = Audience(connection)
    }
}

/** The kind of outcome of a report at one app. */
public enum class AckOutcome {
    /** The app acknowledged the report. */
    ACKNOWLEDGED,

    /** The app responded with a result other than success. */
    REFUSED,

    /** The response of the app is not an acknowledgement. */
    INVALID,

    /** No acknowledgement arrived, in spite of all retries. */
    TIMED_OUT,

    /** The report was dropped for newer ones, because the app was slow. */
    DROPPED,

    /** The connection ended first. */
    CLOSED,
}

/** The outcome of a report at one app. */
public class Acknowledgement internal constructor(
    /** The connection of the app. */
    public val connection: Long,
    /** The kind of outcome. */
    public val outcome: AckOutcome,
    /** The refusal of the app, if any. */
    public val refusal: Refusal?,
) {
    override fun toString(): String = "$connection: $outcome"
}

/** The kind of an error that kept a report or stream from being queued. */
public enum class PushErrorKind(
    /** The fixed name. */
    public val text: String,
) {
    /** The report breaks one of its constraints. */
    INVALID("invalid_report"),

    /** The data does not fit into a frame. */
    FRAME("frame"),

    /** The connection is closed; for a stream: the app has no open data connection. */
    NO_CONNECTION("no_connection"),

    /** Several apps share the address, so the owner of the data connection is unknown. */
    AMBIGUOUS("ambiguous"),
}

/** The error that kept a report or stream from being queued. */
public class PushError internal constructor(
    /** The kind of the error. */
    public val kind: PushErrorKind,
    cause: Exception? = null,
) : Exception(if (cause == null) kind.text else "${kind.text}: ${cause.message}", cause) {
    /** The fixed name of the error. */
    public val name: String get() = kind.text
}

/** A report that is queued for one app, or in flight to it. */
internal class Queued(
    val code: Int,
    val policy: AckPolicy,
    val body: Prepared,
    val ended: (AckOutcome, Refusal?) -> Unit,
)
