package fc.runtime

import java.util.ArrayDeque
import java.util.PriorityQueue

/** What a frame that has arrived means. */
internal sealed interface Incoming<out T> {
    /** The answer to a request in flight, which has ended with it. */
    class Answer<T>(val token: T) : Incoming<T>

    /** An answer that nobody waits for (any more): drop it. */
    object Late : Incoming<Nothing>

    /** A command: handle it and answer. */
    object Command : Incoming<Nothing>

    /** A report: hand it on, then say so with [Session.handedOn], and acknowledge it. */
    object Report : Incoming<Nothing>

    /** A report that has been handed on already: acknowledge it again, nothing else. */
    object Repeated : Incoming<Nothing>

    /** Raw bytes. */
    object Stream : Incoming<Nothing>
}

/** What time has brought about for a request in flight. */
internal sealed interface Due<out T> {
    val frame: FrameId
    val token: T

    /** Send it again, with the same id. */
    class Again<T>(override val frame: FrameId, override val token: T) : Due<T>

    /** There is no answer, and no repetition is left: it has ended. */
    class Expired<T>(override val frame: FrameId, override val token: T) : Due<T>
}

/**
 * Which answer belongs to which request, what is due, what has been seen before. App and robot use the same machine: the
 * one opens commands and receives reports, the other the reverse.
 *
 * It has neither sockets nor a clock: it is told what has happened and what time it is, in milliseconds. Every token given
 * to [open] comes back exactly once. Ids count on from [firstId], and from 0 behind the largest.
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

    // No more than half of all ids: one that was in use a moment ago is not the next.
    private val halfOfIds = minOf(idMax / 2 + 1, Int.MAX_VALUE.toLong()).toInt()
    private val limit = minOf(limits.inFlight, halfOfIds)
    private val open = HashMap<Long, Entry<T>>()

    /** When which id is due, among them those of requests that have ended since. */
    private val deadlines = PriorityQueue<Deadline>()
    private var nextId = firstId and idMax
    private var order = 0L

    // A peer repeats what is in flight, and as much of it as its own limit allows.
    private val seen = Seen(
        minOf(maxOf(limits.queuedReports, limits.inFlight, protocol.defaults.limits.inFlight), halfOfIds),
        saturated(2 * (ack.retries.toLong() + 1), ack.timeout),
    )

    /** How many requests are in flight. */
    val inFlight: Int get() = open.size

    /** Puts a request in flight and gives the id to send it with; `null` if too many are. */
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

    /** Says what a frame means. The [digest] tells reports apart that came over different connections. */
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

    /** Remembers that a report has been handed on. */
    fun handedOn(report: FrameId, digest: ByteArray?, now: Long): Unit = seen.insert(report, digest, now)

    /** Notes that what comes from now on comes over another connection. */
    fun reconnected(): Unit = seen.reconnected()

    /** Ends a request because nobody waits for its answer any more; whether it was in flight. */
    fun cancel(request: FrameId): Boolean = end(request) != null

    private fun end(frame: FrameId): Entry<T>? {
        val entry = open[frame.id] ?: return null
        if (entry.frame.kind != frame.kind || entry.frame.code != frame.code) return null
        open.remove(frame.id)
        return entry
    }

    /** What is due; call it until it gives `null`. */
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

    /** When something is due; `null` for never. */
    fun nextDue(): Long? {
        while (true) {
            val first = deadlines.peek() ?: return null
            if (entryOf(first) != null) return first.due
            deadlines.poll()
        }
    }

    private fun entryOf(deadline: Deadline): Entry<T>? = open[deadline.id]?.takeIf { it.due == deadline.due }

    /** Most requests end before they are due: as many deadlines are forgotten as have gathered since the last time. */
    private fun forget() {
        if (deadlines.size < 2 * open.size + 16) return
        val kept = deadlines.filter { entryOf(it) != null }
        deadlines.clear()
        deadlines.addAll(kept)
    }

    /** Ends every request in flight that [ends] says so of, as when the connection is lost. */
    fun endIf(ends: (T) -> Boolean): List<T> {
        val ended = open.values.filter { ends(it.token) }.sortedBy { it.due }
        for (entry in ended) open.remove(entry.frame.id)
        return ended.map { it.token }
    }
}

/** The time [wait] after [now], which is never beyond all times. */
internal fun after(now: Long, wait: Long): Long = if (wait > Long.MAX_VALUE / 2) Long.MAX_VALUE / 2 else now + wait

private fun saturated(factor: Long, time: Long): Long =
    if (time > 0 && factor > Long.MAX_VALUE / 4 / time) Long.MAX_VALUE / 4 else factor * time

/**
 * Reports handed on not long ago, so that a repetition is not handed on again; bounded in number.
 *
 * What has the same id *and* the same data is the same report, whenever it comes. What has only the same id is the same
 * report if it comes soon and over the same connection; later, or over another one, it is another report.
 */
private class Seen(private val length: Int, private val age: Long) {
    private class Entry(val frame: FrameId, val digest: ByteArray?, val connection: Long, val at: Long)

    /** Oldest first. */
    private val window = ArrayDeque<Entry>()

    /** How many in the window have which id: nearly every report is new, and is seen to be so at a glance. */
    private val ids = HashMap<Long, Int>()
    private var connection = 0L

    fun reconnected() {
        connection++
    }

    /** Whether this report has been handed on. If so, its age counts from now. */
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
