package fc.runtime

import java.util.concurrent.CompletableFuture
import kotlinx.coroutines.flow.Flow
import kotlinx.coroutines.flow.flow

/**
 * The reports of a connection since the creation of the receiver, in the order received.
 *
 * A report is acknowledged when at least one receiver has it in its queue. A receiver without room then misses it. The
 * receiver continues over reconnections. It ends when the connection is closed and the queue empty.
 */
public class Reports internal constructor(private val receiver: Queues.Receiver) : AutoCloseable {
    /**
     * Returns the next report, or `null` if the connection is closed and the queue empty. Cancelling loses no report.
     */
    @JvmSynthetic
    public suspend fun receive(): ReceivedReport? = receiver.next(receiver::poll)

    /** Returns the next report, if one is queued. */
    public fun poll(): ReceivedReport? = receiver.poll()

    /** The reports as a flow. It ends like [receive]. */
    public fun asFlow(): Flow<ReceivedReport> = flow { while (true) emit(receive() ?: break) }

    /** Returns the number of reports missed since the last call, because the queue was full. */
    public fun missed(): Long = receiver.missed()

    /** Takes no more reports. */
    override fun close(): Unit = receiver.leave()
}

/** An event of a followed process. */
public sealed class Followed<out R> {
    /** The report of the event, if any. */
    public open val report: R? get() = null

    /** The process goes on. */
    public class Going<R> internal constructor(override val report: R) : Followed<R>()

    /** The process has ended with a final state. */
    public class Ended<R> internal constructor(override val report: R) : Followed<R>()

    /** The report means a failure. The last event. */
    public class Failed<R> internal constructor(override val report: R) : Followed<R>()

    /** Reports did not fit into this queue while another receiver took them. */
    public class Missed internal constructor(
        /** Number of reports. */
        public val reports: Long,
    ) : Followed<Nothing>()

    /** The connection was lost. The events continue with the reports after the next connection. */
    public class Interrupted internal constructor(
        /** The reason of the loss. */
        public val loss: Loss,
    ) : Followed<Nothing>()

    /** The connection is up again. Reports may be missing: query the state of the robot. */
    public object Resumed : Followed<Nothing>()

    /** `true` for the last event: the process has ended or failed. */
    public val isOver: Boolean get() = this is Ended || this is Failed

    override fun toString(): String = "${javaClass.simpleName}(${report ?: ""})"
}

/** The connection is closed for good. The followed process may go on. */
public class FollowError internal constructor(
    /** The reason of the loss. */
    public val loss: Loss,
) : Exception("the connection is closed: $loss; the process may go on") {
    /** The fixed name. */
    public val name: String get() = "closed"
}

/**
 * An accepted command and the reports of its process.
 *
 * It ends after [Followed.Ended], [Followed.Failed] or a [FollowError]. If the spec defines neither final states nor
 * failures, it continues until it is closed. A report whose state violates the order is returned like any other and
 * counted.
 */
public class Following<A : Message, R : Message> internal constructor(
    private val core: ClientCore,
    private val receiver: Queues.Receiver,
    private val kind: Report<R>,
    /** The response of the robot to the command. */
    public val answer: A,
    private val belongs: (R) -> Boolean,
) : AutoCloseable {
    private var last: State? = null
    private var isOver = false

    /**
     * Returns the next event, or `null` after the end.
     *
     * @throws FollowError if the connection is closed although the process may go on
     */
    @JvmSynthetic
    public suspend fun receive(): Followed<R>? {
        while (!isOver) {
            val arrival = receiver.next(receiver::pollArrival)
            if (arrival == null) {
                val why = receiver.end ?: return null
                close()
                throw FollowError(why)
            }
            val next = followed(arrival) ?: continue
            if (next.isOver) close()
            return next
        }
        return null
    }

    /** [receive] for Java. The value is `null` after the end. */
    public fun receiveAsync(): CompletableFuture<Followed<R>?> = Futures.of { receive() }

    private fun followed(arrival: Arrival): Followed<R>? = when (arrival) {
        is Arrival.Missed -> Followed.Missed(arrival.reports)
        is Arrival.Lost -> Followed.Interrupted(arrival.why)
        is Arrival.Connected -> Followed.Resumed
        is Arrival.Report -> {
            @Suppress("UNCHECKED_CAST")
            val report = arrival.report.message as R
            if (belongs(report)) place(report) else null
        }
    }

    private fun place(report: R): Followed<R> {
        val state = kind.stateIn(report)
        val before = last
        if (before != null && state != null && !state.mayFollow(before)) core.counting.add(ClientCount.REPORTS_OUT_OF_ORDER)
        last = state ?: before
        return when {
            kind.isFailure(report) -> Followed.Failed(report)
            state?.isFinal == true -> Followed.Ended(report)
            else -> Followed.Going(report)
        }
    }

    /** The events as a flow. It ends like [receive]. */
    public fun asFlow(): Flow<Followed<R>> = flow {
        try {
            while (true) emit(receive() ?: break)
        } finally {
            close()
        }
    }

    /** Stops following. */
    override fun close() {
        isOver = true
        receiver.leave()
    }
}
