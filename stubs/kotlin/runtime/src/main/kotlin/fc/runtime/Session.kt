package fc.runtime

import java.util.ArrayDeque
import java.util.PriorityQueue

/** The meaning of a received frame. */
internal sealed interface Incoming<out T> {
    /** The response to a request in flight, which ends with it. */
    class Answer<T>(val token: T) : Incoming<T>

    /** A response without a request in flight: drop it. */
    object Late : Incoming<Nothing>

    /** A command: handle it and respond. */
    object Command : Incoming<Nothing>

    /** A report: hand it on, call [Session.handedOn], and acknowledge it. */
    object Report : Incoming<Nothing>

    /** A report that was handed on before: only acknowledge it again. */
    object Repeated : Incoming<Nothing>

    /** Raw bytes. */
    object Stream : Incoming<Nothing>
}

/** A request whose wait has ended. */
internal sealed interface Due<out T> {
    val frame: FrameId
    val token: T

    /** Send it again, with the same id. */
    class Again<T>(override val frame: FrameId, override val token: T) : Due<T>

    /** The request has ended: no response and no retry is left. */
    class Expired<T>(override val frame: FrameId, override val token: T) : Due<T>
}

/**
 * Matches responses with requests, finds due retries, and detects repeated reports. App and robot use the same session:
 * the app opens commands and receives reports, the robot vice versa.
 *
 * It has neither sockets nor a clock: the caller feeds it events and the time in milliseconds. Every token given to
 * [open] returns exactly once. Ids count up from [firstId], and continue at 0 after the largest.
 */
internal class Session<T>(private val protocol: Protocol, limits: Limits, ack: AckPolicy, firstId: Long) {
    private class Entry<T>(
        val frame: FrameId,
        val token: T,
        val timeout: Long,
        var due: Long,
        var retriesLeft: Int,
    )

    private class Deadline(val due: Long, val order: Long, val id: Long) : Comparable<Deadline> {
        override fun compareTo(other: Deadline): Int =
            if (due != other.due) due.compareTo(other.due) else order.compareTo(other.order)
    }

    private val idMax = protocol.header.idMax

    // At most half of all ids, so that an id in recent use is not the next.
    private val halfOfIds = minOf(idMax / 2 + 1, Int.MAX_VALUE.toLong()).toInt()
    private val limit = minOf(limits.inFlight, halfOfIds)
    private val open = HashMap<Long, Entry<T>>()

    /** The deadlines with their ids. May contain requests that have ended. */
    private val deadlines = PriorityQueue<Deadline>()
    private var nextId = firstId and idMax
    private var order = 0L

    // A peer repeats the reports in flight, up to its own limit.
    private val seen = Seen(
        minOf(maxOf(limits.queuedReports, limits.inFlight, protocol.defaults.limits.inFlight), halfOfIds),
        saturated(2 * (ack.retries.toLong() + 1), ack.timeout),
    )

    /** Number of requests in flight. */
    val inFlight: Int get() = open.size

    /** Opens a request and returns its id, or `null` if too many are in flight. */
    fun open(kind: Int, code: Int, policy: AckPolicy, now: Long, token: T): FrameId? {
        if (open.size >= limit) return null
        while (open.containsKey(nextId)) nextId = nextId + 1 and idMax
        val frame = FrameId(false, kind, code, nextId)
        nextId = nextId + 1 and idMax
        val entry = Entry(frame, token, policy.timeout, after(now, policy.timeout), policy.retries)
        open[frame.id] = entry
        forget()
        deadlines.add(Deadline(entry.due, order++, frame.id))
        return frame
    }

    /** Returns the meaning of a frame. The [digest] distinguishes reports over different connections. */
    fun receive(frame: FrameId, digest: ByteArray?, now: Long): Incoming<T> {
        if (frame.isResponse) {
            val entry = end(frame) ?: return Incoming.Late
            return Incoming.Answer(entry.token)
        }
        return when (frame.kind) {
            protocol.reportKind -> if (seen.contains(frame, digest, now)) Incoming.Repeated else Incoming.Report
            protocol.streamKind -> Incoming.Stream
            else -> Incoming.Command
        }
    }

    /** Remembers a report that was handed on. */
    fun handedOn(report: FrameId, digest: ByteArray?, now: Long): Unit = seen.insert(report, digest, now)

    /** Notes that the following frames arrive over a new connection. */
    fun reconnected(): Unit = seen.reconnected()

    /** Cancels a request. Returns `true` if it was in flight. */
    fun cancel(request: FrameId): Boolean = end(request) != null

    private fun end(frame: FrameId): Entry<T>? {
        val entry = open[frame.id] ?: return null
        if (entry.frame.kind != frame.kind || entry.frame.code != frame.code) return null
        open.remove(frame.id)
        return entry
    }

    /** Returns the next due request. Call it until it returns `null`. */
    fun due(now: Long): Due<T>? {
        while (true) {
            val first = deadlines.peek() ?: return null
            val entry = entryOf(first)
            if (entry != null && first.due > now) return null
            deadlines.poll()
            if (entry == null) continue
            if (entry.retriesLeft == 0) {
                open.remove(entry.frame.id)
                return Due.Expired(entry.frame, entry.token)
            }
            entry.retriesLeft--
            entry.due = after(now, entry.timeout)
            deadlines.add(Deadline(entry.due, order++, entry.frame.id))
            return Due.Again(entry.frame, entry.token)
        }
    }

    /** Returns the next deadline, or `null` if there is none. */
    fun nextDue(): Long? {
        while (true) {
            val first = deadlines.peek() ?: return null
            if (entryOf(first) != null) return first.due
            deadlines.poll()
        }
    }

    private fun entryOf(deadline: Deadline): Entry<T>? = open[deadline.id]?.takeIf { it.due == deadline.due }

    /** Most requests end before their deadline. Once enough of these have accumulated, they are removed. */
    private fun forget() {
        if (deadlines.size < 2 * open.size + 16) return
        val kept = deadlines.filter { entryOf(it) != null }
        deadlines.clear()
        deadlines.addAll(kept)
    }

    /** Ends every request in flight for which [ends] returns `true`, such as after a loss. */
    fun endIf(ends: (T) -> Boolean): List<T> {
        val ended = open.values.filter { ends(it.token) }.sortedBy { it.due }
        for (entry in ended) open.remove(entry.frame.id)
        return ended.map { it.token }
    }
}

/** Returns the time [wait] after [now], without overflow. */
internal fun after(now: Long, wait: Long): Long = if (wait > Long.MAX_VALUE / 2) Long.MAX_VALUE / 2 else now + wait

private fun saturated(factor: Long, time: Long): Long =
    if (time > 0 && factor > Long.MAX_VALUE / 4 / time) Long.MAX_VALUE / 4 else factor * time

/**
 * A bounded window over the last reports handed on, so that a repetition is not handed on again.
 *
 * A report with the same id and data is a repetition at any time. A report with only the same id is a repetition if it
 * arrives soon and over the same connection. Otherwise it is new.
 */
private class Seen(private val length: Int, private val age: Long) {
    private class Entry(val frame: FrameId, val digest: ByteArray?, val connection: Long, val at: Long)

    /** Oldest first. */
    private val window = ArrayDeque<Entry>()

    /** The number of reports per id in the window. It shows quickly that a report is new, as nearly all are. */
    private val ids = HashMap<Long, Int>()
    private var connection = 0L

    fun reconnected() {
        connection++
    }

    /** Returns `true` if this report was handed on. Its age then restarts. */
    fun contains(frame: FrameId, digest: ByteArray?, now: Long): Boolean {
        if (frame.id !in ids) return false
        val newestFirst = window.descendingIterator()
        while (newestFirst.hasNext()) {
            val entry = newestFirst.next()
            if (entry.frame != frame || !isSame(entry, digest, now)) continue
            newestFirst.remove()
            window.addLast(Entry(frame, entry.digest, connection, now))
            return true
        }
        return false
    }

    private fun isSame(entry: Entry, digest: ByteArray?, now: Long): Boolean {
        val isRecent = now - entry.at <= age
        if (entry.digest == null || digest == null) return isRecent
        return entry.digest.contentEquals(digest) || (isRecent && entry.connection == connection)
    }

    fun insert(frame: FrameId, digest: ByteArray?, now: Long) {
        if (length == 0) return
        if (window.size == length) {
            val oldest = window.removeFirst().frame.id
            val left = (ids[oldest] ?: 1) - 1
            if (left == 0) ids.remove(oldest) else ids[oldest] = left
        }
        window.addLast(Entry(frame, digest, connection, now))
        ids[frame.id] = (ids[frame.id] ?: 0) + 1
    }
}
