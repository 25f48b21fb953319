package fc.runtime

import kotlinx.coroutines.channels.Channel

/** A received report. */
public class ReceivedReport internal constructor(
    /** Command code. */
    public val code: Int,
    /** Message id. */
    public val id: Long,
    /** The typed report; `null` if the spec does not define its code. */
    public val message: Message?,
    private val text: ByteArray,
) {
    /** The complete JSON text, including the envelope. */
    public val json: String get() = String(text, Charsets.UTF_8)

    internal val bytes: Int get() = text.size

    override fun toString(): String = "ReceivedReport(code=$code, id=$id, $bytes bytes)"
}

/** An event for a receiver: a report, or an event between two reports. */
internal sealed interface Arrival {
    class Missed(val reports: Long) : Arrival

    class Lost(val why: Loss) : Arrival

    object Connected : Arrival

    class Report(val report: ReceivedReport) : Arrival
}

/** Received reports in a bounded queue per receiver. The loop fills the queues, and any thread takes from them. */
internal class Queues(private val limit: Int, private val bytesLimit: Long) {
    private val receivers = ArrayList<Receiver>()

    /** The reason of the end, if any. */
    private var over: Loss? = null

    /** The queue of one receiver, for reports with one code or any. */
    inner class Receiver(private val code: Int?) {
        private val waiting = ArrayDeque<Pair<Before, ReceivedReport>>()
        private var since = Before()
        private var isCut = false
        private var bytes = 0L
        private var missed = 0L
        private val signal = Channel<Unit>(Channel.CONFLATED)

        internal fun takes(report: ReceivedReport) = code == null || code == report.code

        internal fun hasRoom(report: ReceivedReport) = waiting.size < limit && bytes + report.bytes <= bytesLimit

        internal fun add(report: ReceivedReport) {
            bytes += report.bytes
            waiting.addLast(since to report)
            since = Before()
            signal.trySend(Unit)
        }

        internal fun miss() {
            missed++
            since.missed++
        }

        internal fun lost(why: Loss) {
            isCut = true
            since.lost = why
            since.connected = false
            signal.trySend(Unit)
        }

        internal fun connected() {
            if (isCut) since.connected = true
            isCut = false
            signal.trySend(Unit)
        }

        internal fun wake() {
            signal.trySend(Unit)
        }

        private fun pop(): ReceivedReport? {
            val (_, report) = waiting.removeFirstOrNull() ?: return null
            bytes -= report.bytes
            if (waiting.isNotEmpty()) signal.trySend(Unit)
            return report
        }

        /** Returns the oldest report, if any. */
        fun poll(): ReceivedReport? = synchronized(this@Queues) { pop() }

        /** Returns the next event, if any. */
        fun pollArrival(): Arrival? = synchronized(this@Queues) {
            val before = waiting.firstOrNull()?.first ?: since
            val lost = before.lost
            when {
                before.missed > 0 -> Arrival.Missed(before.missed).also { before.missed = 0 }
                lost != null -> Arrival.Lost(lost).also { before.lost = null }
                before.connected -> Arrival.Connected.also { before.connected = false }
                else -> pop()?.let { Arrival.Report(it) }
            }
        }

        /** Waits until `poll` returns something. Returns `null` after the end. */
        suspend fun <T : Any> next(poll: () -> T?): T? {
            while (true) {
                poll()?.let { return it }
                if (synchronized(this@Queues) { over != null || this !in receivers }) {
                    signal.trySend(Unit)
                    return poll()
                }
                signal.receive()
            }
        }

        /** The reason of the end, if any. */
        val end: Loss? get() = synchronized(this@Queues) { over }

        fun missed(): Long = synchronized(this@Queues) { missed.also { missed = 0 } }

        fun leave() {
            synchronized(this@Queues) { receivers.remove(this) }
            signal.trySend(Unit)
        }
    }

    private class Before {
        var missed = 0L
        var lost: Loss? = null
        var connected = false
    }

    /** Adds a receiver of reports with this code, or any. */
    @Synchronized
    fun enter(code: Int?): Receiver = Receiver(code).also { receivers.add(it) }

    /** Queues a report at all receivers with room. Returns how many had none, or -1 if none took it. */
    @Synchronized
    fun push(report: ReceivedReport): Int {
        val takers = receivers.filter { it.takes(report) }
        if (over != null || takers.none { it.hasRoom(report) }) return -1
        var missed = 0
        for (receiver in takers) {
            if (receiver.hasRoom(report)) {
                receiver.add(report)
            } else {
                receiver.miss()
                missed++
            }
        }
        return missed
    }

    @Synchronized
    fun lost(why: Loss): Unit = receivers.forEach { it.lost(why) }

    @Synchronized
    fun connected(): Unit = receivers.forEach { it.connected() }

    @Synchronized
    fun end(why: Loss) {
        over = why
        receivers.forEach { it.wake() }
    }
}
