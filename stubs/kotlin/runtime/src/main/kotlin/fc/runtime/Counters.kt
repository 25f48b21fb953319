package fc.runtime

import java.util.concurrent.atomic.AtomicLongArray

/** The counters of a connection since it was created. They continue over reconnections. */
public class ClientCounters internal constructor(private val counts: LongArray) {
    /** Bytes received. */
    public val bytesIn: Long get() = counts[0]

    /** Bytes handed to the connection to be sent. */
    public val bytesOut: Long get() = counts[1]

    /** Responses that reached their call. */
    public val answers: Long get() = counts[2]

    /** Responses without a waiting call. */
    public val lateAnswers: Long get() = counts[3]

    /** Calls that ended without a response in time. */
    public val timeouts: Long get() = counts[4]

    /** Reports put into the queue of at least one receiver, and acknowledged. */
    public val reports: Long get() = counts[5]

    /** Reports that a full receiver missed while another one took them, counted per receiver. */
    public val reportsMissed: Long get() = counts[6]

    /** Repeated reports that were only acknowledged again. */
    public val repeatedReports: Long get() = counts[7]

    /** Reports left unacknowledged because no receiver had room. */
    public val reportsRefused: Long get() = counts[8]

    /** Reports refused because their body or envelope is invalid. */
    public val reportsInvalid: Long get() = counts[9]

    /** Reports more than one and a half intervals after the previous one with the same code. */
    public val reportsLate: Long get() = counts[10]

    /** Reports that violate the order in the spec, counted by each follower of the process. */
    public val reportsOutOfOrder: Long get() = counts[11]

    /** Frames that could not be read. */
    public val badFrames: Long get() = counts[12]
}

internal enum class ClientCount {
    BYTES_IN, BYTES_OUT, ANSWERS, LATE_ANSWERS, TIMEOUTS, REPORTS, REPORTS_MISSED, REPEATED_REPORTS, REPORTS_REFUSED,
    REPORTS_INVALID, REPORTS_LATE, REPORTS_OUT_OF_ORDER, BAD_FRAMES,
}

/** The counters of a robot. */
public class ServerCounters internal constructor(private val counts: LongArray) {
    /** Command connections accepted. */
    public val connections: Long get() = counts[0]

    /** Data connections accepted. */
    public val dataConnections: Long get() = counts[1]

    /** Connections closed at once because there were too many. */
    public val connectionsRefused: Long get() = counts[2]

    /** Silent connections closed to make room for another. */
    public val connectionsDisplaced: Long get() = counts[3]

    /** Connections closed because they made no progress. */
    public val connectionsTimedOut: Long get() = counts[4]

    /** Calls with result success. */
    public val callsAnswered: Long get() = counts[5]

    /** Calls with another result. */
    public val callsRefused: Long get() = counts[6]

    /** Calls whose handler took too long. */
    public val callsTimedOut: Long get() = counts[7]

    /** Calls of commands that this robot does not implement. */
    public val callsNotImplemented: Long get() = counts[8]

    /** Handlers that failed with an exception other than a refusal, also after their timeout. */
    public val handlersPanicked: Long get() = counts[9]

    /** Handlers that continued without a waiting app. */
    public val handlersAbandoned: Long get() = counts[10]

    /** Commands refused because of too many abandoned handlers. */
    public val abandonedReached: Long get() = counts[11]

    /** Reports acknowledged. */
    public val reportsAcknowledged: Long get() = counts[12]

    /** Reports that an app refused. */
    public val reportsRefused: Long get() = counts[13]

    /** Reports sent again. */
    public val reportsRepeated: Long get() = counts[14]

    /** Reports without an acknowledgement in time. */
    public val reportsTimedOut: Long get() = counts[15]

    /** Reports dropped for newer ones. */
    public val reportsDropped: Long get() = counts[16]

    /** Frames that could not be read. */
    public val badFrames: Long get() = counts[17]

    /** Frames of streams received. */
    public val streamFramesIn: Long get() = counts[18]

    /** Frames of streams without a receiver. */
    public val streamFramesDropped: Long get() = counts[19]

    /** Frames of streams sent. */
    public val streamFramesOut: Long get() = counts[20]

    /** Bytes received. */
    public val bytesIn: Long get() = counts[21]

    /** Bytes handed to connections to be sent. */
    public val bytesOut: Long get() = counts[22]

    /** Connections closed at once because their address is not allowed. */
    public val connectionsForbidden: Long get() = counts[23]

    /** Calls refused because of the address of the app. */
    public val callsForbidden: Long get() = counts[24]

    /** Pauses of a connection after too many useless frames. */
    public val connectionsPaced: Long get() = counts[25]

    /** Connections closed because memory was short and they held most. */
    public val connectionsEvicted: Long get() = counts[26]
}

internal enum class ServerCount {
    CONNECTIONS, DATA_CONNECTIONS, CONNECTIONS_REFUSED, CONNECTIONS_DISPLACED, CONNECTIONS_TIMED_OUT, CALLS_ANSWERED,
    CALLS_REFUSED, CALLS_TIMED_OUT, CALLS_NOT_IMPLEMENTED, HANDLERS_PANICKED, HANDLERS_ABANDONED, ABANDONED_REACHED,
    REPORTS_ACKNOWLEDGED, REPORTS_REFUSED, REPORTS_REPEATED, REPORTS_TIMED_OUT, REPORTS_DROPPED, BAD_FRAMES,
    STREAM_FRAMES_IN, STREAM_FRAMES_DROPPED, STREAM_FRAMES_OUT, BYTES_IN, BYTES_OUT, CONNECTIONS_FORBIDDEN, CALLS_FORBIDDEN,
    CONNECTIONS_PACED, CONNECTIONS_EVICTED,
}

/** Counters by name. Any thread may use them. */
internal class Counting<E : Enum<E>>(size: Int) {
    private val counts = AtomicLongArray(size)

    fun add(what: E, more: Long = 1) {
        counts.addAndGet(what.ordinal, more)
    }

    fun read(): LongArray = LongArray(counts.length()) { counts.get(it) }
}
