package fc.runtime

import kotlinx.coroutines.flow.Flow
import kotlinx.coroutines.flow.flow

/**
 * The reports of a connection from the receiver's creation on, in the order they came.
 *
 * A report is acknowledged when at least one receiver has it in its queue; a receiver that had no room then has missed it.
 * It goes on over reconnecting, and ends when the connection is closed and the queue empty.
 */
public class Reports internal constructor(private val receiver: Queues.Receiver) : AutoCloseable {
    /** The next report; `null` once the connection is closed and no report is left. Cancelling loses none. */
    @JvmSynthetic
    public suspend fun receive(): ReceivedReport? = receiver.next(receiver::poll)

    /** The next report, if it is there already. */
    public fun poll(): ReceivedReport? = receiver.poll()

    /** The reports as a flow, which ends as [receive] does. */
    public fun asFlow(): Flow<ReceivedReport> = flow { while (true) emit(receive() ?: break) }

    /** How many reports this receiver has missed since this was last asked, because its queue was full. */
    public fun missed(): Long = receiver.missed()

    /** Takes no more reports. */
    override fun close(): Unit = receiver.leave()
}

/** An event of a process that is being followed. */
public sealed class Followed<out R> {
    /** The report, if it is one. */
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
        /** Why. */
        public val loss: Loss,
    ) : Followed<Nothing>()

    /** There is a connection again. What the robot has reported meanwhile may never come: query its state. */
    public object Resumed : Followed<Nothing>()

    /** Whether it says that the process is over, well or not: nothing comes after it. */
    public val isOver: Boolean get() = this is Ended || this is Failed

    override fun toString(): String = "${javaClass.simpleName}(${report ?: ""})"
}

/** The connection is closed for good, and what is followed may go on. */
public class FollowError internal constructor(
    /** Why the connection was closed. */
    public val loss: Loss,
) : Exception("the connection is closed: $loss; the process may go on") {
    /** The fixed name. */
    public val name: String get() = "closed"
}

/**
 * A command that has been answered, and the reports that it sets off.
 *
 * It ends after [Followed.Ended], [Followed.Failed] or a [FollowError]. Where the spec says neither which state is the last
 * nor which are failures, it goes on until it is closed. A report whose state does not come after the one before is handed on
 * like any other and counted as out of order.
 */
public class Following<A : Message, R : Message> internal constructor(
    private val core: ClientCore,
    private val receiver: Queues.Receiver,
    private val kind: Report<R>,
    /** What the robot has answered to the command. */
    public val answer: A,
    private val belongs: (R) -> Boolean,
) : AutoCloseable {
    private var last: State? = null
    private var isOver = false

    /**
     * What comes next; `null` after the end.
     *
     * @throws FollowError if nothing more will come although the process may go on
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

    /** What comes as a flow, which ends as [receive] does. */
    public fun asFlow(): Flow<Followed<R>> = flow {
        try {
            while (true) emit(receive() ?: break)
        } finally {
            close()
        }
    }

    /** Follows no further. */
    override fun close() {
        isOver = true
        receiver.leave()
    }
}
