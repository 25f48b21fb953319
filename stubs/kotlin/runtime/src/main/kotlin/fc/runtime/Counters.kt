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

/** The counters of a robot since its start. */
public class ServerCounters internal constructor(private val counts: LongArray) {
    /** Connections accepted at the command port. */
    public val connections: Long get() = counts[0]

    /** Connections accepted at the data port. */
    public val dataConnections: Long get() = counts[1]

    /** Connections closed at once at the limit, in total or from their address. */
    public val connectionsRefused: Long get() = counts[2]

    /** Connections closed at once because their address is not allowed. */
    public val connectionsForbidden: Long get() = counts[3]

    /** Connections closed because memory was short and they held most of it. */
    public val connectionsEvicted: Long get() = counts[4]

    /** Silent connections closed to make room for another. */
    public val connectionsDisplaced: Long get() = counts[5]

    /** Connections closed by a timeout: of a header, of a stalled frame or reader, or of silence. */
    public val connectionsTimedOut: Long get() = counts[6]

    /** Times a connection was not read for a while because of useless frames. */
    public val connectionsPaced: Long get() = counts[7]

    /** Requests with a response of success. */
    public val callsSucceeded: Long get() = counts[8]

    /** Requests with the result for a protocol error. */
    public val callsProtocol: Long get() = counts[9]

    /** Requests with the result for a timeout. */
    public val callsTimedOut: Long get() = counts[10]

    /** Requests with the result for an invalid parameter. */
    public val callsInvalid: Long get() = counts[11]

    /** Requests with the result for an expired message. */
    public val callsExpired: Long get() = counts[12]

    /** Requests to which a handler gave another result. */
    public val callsRefused: Long get() = counts[13]

    /** Requests refused because their address does not allow them; included in [callsProtocol]. */
    public val callsForbidden: Long get() = counts[14]

    /** Requests refused because the robot does not implement their command; included in [callsProtocol]. */
    public val callsNotImplemented: Long get() = counts[15]

    /**
     * Handlers that failed with an exception other than a [Refusal]. Their requests are included in [callsProtocol], or
     * earlier in [callsTimedOut].
     */
    public val handlersPanicked: Long get() = counts[16]

    /** Handlers that were still running when their response was no longer awaited. */
    public val handlersAbandoned: Long get() = counts[17]

    /** Requests refused because `abandonedHandlers` of these were running; included in [callsProtocol]. */
    public val abandonedReached: Long get() = counts[18]

    /** Times a connection was not read because it had the most requests in flight. */
    public val inFlightReached: Long get() = counts[19]

    /** Frames that could not be read. */
    public val badFrames: Long get() = counts[20]

    /** Reports sent for the first time, counted per app. */
    public val reportsSent: Long get() = counts[21]

    /** Reports sent again. */
    public val reportsRepeated: Long get() = counts[22]

    /** Reports acknowledged with success. */
    public val reportsAcknowledged: Long get() = counts[23]

    /** Reports acknowledged with another result. */
    public val reportsRefused: Long get() = counts[24]

    /** Reports given up after the last repetition. */
    public val reportsTimedOut: Long get() = counts[25]

    /** Reports dropped because an app's queue was full. */
    public val reportsDropped: Long get() = counts[26]

    /** Frames of streams received. */
    public val streamFramesIn: Long get() = counts[27]

    /** Frames of streams sent. */
    public val streamFramesOut: Long get() = counts[28]

    /** Frames of streams dropped for lack of a receiver. */
    public val streamFramesDropped: Long get() = counts[29]

    /** Bytes received. */
    public val bytesIn: Long get() = counts[30]

    /** Bytes sent. */
    public val bytesOut: Long get() = counts[31]

    /** Connections closed because their TLS handshake failed or took too long. */
    public val handshakesFailed: Long get() = counts[32]
}

internal enum class ServerCount {
    CONNECTIONS, DATA_CONNECTIONS, CONNECTIONS_REFUSED, CONNECTIONS_FORBIDDEN, CONNECTIONS_EVICTED,
    CONNECTIONS_DISPLACED, CONNECTIONS_TIMED_OUT, CONNECTIONS_PACED, CALLS_SUCCEEDED, CALLS_PROTOCOL, CALLS_TIMED_OUT,
    CALLS_INVALID, CALLS_EXPIRED, CALLS_REFUSED, CALLS_FORBIDDEN, CALLS_NOT_IMPLEMENTED, HANDLERS_PANICKED,
    HANDLERS_ABANDONED, ABANDONED_REACHED, IN_FLIGHT_REACHED, BAD_FRAMES, REPORTS_SENT, REPORTS_REPEATED,
    REPORTS_ACKNOWLEDGED, REPORTS_REFUSED, REPORTS_TIMED_OUT, REPORTS_DROPPED, STREAM_FRAMES_IN, STREAM_FRAMES_OUT,
    STREAM_FRAMES_DROPPED, BYTES_IN, BYTES_OUT, HANDSHAKES_FAILED,
}

/** Counters by name. Any thread may use them. */
internal class Counting<E : Enum<E>>(size: Int) {
    private val counts = AtomicLongArray(size)

    fun add(what: E, more: Long = 1) {
        counts.addAndGet(what.ordinal, more)
    }

    fun read(): LongArray = LongArray(counts.length()) { counts.get(it) }
}
