package fc.runtime

import java.io.IOException
import kotlin.coroutines.resumeWithException
import kotlinx.coroutines.CancellableContinuation

/** The event loop of one thread, with a clock. All work of a connection runs on its loop. */
internal interface Loop {
    /** The time of a monotonic clock, in milliseconds. */
    val now: Long

    /** Runs a task on the loop, after those before it. For any thread. */
    fun execute(task: () -> Unit)

    /** Runs a task at a time. For the loop alone. */
    fun schedule(at: Long, task: () -> Unit): Timer
}

/** Runs a task on the loop for a suspended coroutine, which gets the exception of the task. */
internal fun Loop.execute(waiting: CancellableContinuation<*>, task: () -> Unit) = execute {
    try {
        task()
    } catch (failure: Throwable) {
        if (waiting.isActive) waiting.resumeWithException(failure)
    }
}

/** A scheduled task, which can be cancelled before it runs. */
internal interface Timer {
    fun cancel()
}

/** The byte stream of a connection. No method blocks, and all are called on the loop. */
internal interface Link {
    /** Starts the link. [ready] is called on the loop when an operation requested by [want] is possible. */
    fun open(ready: () -> Unit)

    /** Reads available bytes. Returns their number; 0 if there are none yet, -1 at the end. */
    @Throws(IOException::class)
    fun read(into: ByteArray): Int

    /** Writes as many bytes as possible now, and returns their number. */
    @Throws(IOException::class)
    fun write(bytes: ByteArray, from: Int, length: Int): Int

    /** Sets the operations to call back for. */
    fun want(read: Boolean, write: Boolean)

    /** Closes the outgoing half. */
    @Throws(IOException::class)
    fun endOutput()

    /** Closes both halves. */
    fun close()
}

/** Makes a connection on request, and calls back on the loop. */
internal fun interface Dial {
    /** Starts to connect. Cancel the result to stop. */
    fun dial(done: (Link?, Exception?) -> Unit): Timer
}

/** The end of a connection. */
internal sealed interface End {
    /** Neither reading nor writing is possible. */
    class Broken(
        val cause: IOException,
        /** `true` for a failure of the runtime rather than of the network. */
        val isOwn: Boolean = false,
    ) : End

    /** The peer has closed its half, or its bytes are not a valid sequence of frames. */
    class Deaf(val error: FrameError?) : End
}

/**
 * One connection. It reads and writes frames and schedules its work.
 *
 * All work belongs to a turn. A turn runs when something can be read or written, when a deadline has come, or after
 * [wake]. For the loop alone.
 */
internal abstract class Conversation(protected val loop: Loop, private val link: Link, protected val decoder: Decoder) {
    private val out = ArrayDeque<ByteArray>()
    private var written = 0
    private val scratch = ByteArray(READ)
    private var isWoken = false
    private var timer: Timer? = null
    private var armed = Long.MAX_VALUE

    /** `true` once it handles nothing more. It may still be closing. */
    var isOver = false
        private set

    /** Bytes that the peer has not taken yet. */
    var unsent = 0L
        private set

    fun start() {
        link.open { wake() }
        wake()
    }

    /** Runs a turn soon. */
    fun wake() {
        if (isWoken) return
        isWoken = true
        loop.execute {
            isWoken = false
            try {
                if (isOver) partWrites() else turn()
            } catch (failure: Throwable) {
                end(failure)
            }
        }
    }

    /** Ends the connection after a failed turn, without harm to others. */
    private fun end(failure: Throwable) {
        failed(failure)
        try {
            if (!isOver) ended(End.Broken(IOException(failure), isOwn = true))
        } finally {
            cut()
        }
    }

    /** Sends a frame in the next turn. A long body is not copied. */
    fun send(body: Prepared, id: FrameId): Unit =
        if (body.length <= GATHERED) send(body.frame(id)) else send(body.header(id), body.data)

    /** Sends a frame in the next turn, in one piece or two. */
    fun send(first: ByteArray, second: ByteArray? = null) {
        if (isClosed) return
        val length = first.size + (second?.size ?: 0)
        if (unsent == 0L) begins(loop.now)
        out.addLast(first)
        second?.let { out.addLast(it) }
        unsent += length
        sent(length)
        settle()
        wake()
    }

    /** Returns `true` while it reads. */
    protected abstract fun reads(): Boolean

    /** Handles a received frame. */
    protected abstract fun arrived(frame: Frame, now: Long)

    /** Handles the error of a skipped frame. */
    protected abstract fun skipped(error: FrameError, now: Long)

    /** Notes received bytes. With [isFirst], they start a frame. */
    protected abstract fun came(bytes: Int, isFirst: Boolean, now: Long)

    /** Handles an end. */
    protected abstract fun ended(end: End)

    /** Does all due work, and returns the time of the next deadline. */
    protected abstract fun tend(now: Long): Long

    /** Notes that there is something to send after there was nothing. */
    protected abstract fun begins(now: Long)

    /** Notes bytes that the peer has taken. */
    protected abstract fun wrote(bytes: Int, now: Long)

    /** Notes bytes that were handed over to be sent. */
    protected open fun sent(bytes: Int) {}

    /** Handles an exception of a turn. */
    protected abstract fun failed(failure: Throwable)

    /** Makes room for more bytes. Returns `false` if there is none; the conversation is woken when there may be. */
    protected open fun room(bytes: Long): Boolean = true

    /** Notes that the number of held bytes has changed. */
    protected open fun settle() {}

    /** `true` while reading waits for memory. */
    protected var isStarved = false
        private set

    private fun turn() {
        val now = loop.now
        val budget = try {
            receive(now)
        } catch (error: IOException) {
            ended(End.Broken(error))
            1
        }
        if (isOver) return
        var due = tend(now)
        if (isOver) return
        if (write(now) && !isOver) due = minOf(due, tend(now))
        if (isOver) return
        settle()
        if (isOver) return
        link.want(budget > 0 && !isStarved && reads(), unsent > 0)
        if (budget <= 0) wake()
        arm(due)
    }

    /** Reads and handles all available bytes, up to the budget of one turn. Returns the rest of the budget. */
    private fun receive(now: Long): Int {
        var budget = TURN
        isStarved = false
        while (!isOver && reads()) {
            budget = decode(budget, now)
            if (isOver || isStarved || budget <= 0 || !reads()) break
            val growth = decoder.growth(READ)
            if (growth > 0 && !roomFor(growth)) break
            val read = link.read(scratch)
            if (read == 0) break
            if (read < 0) {
                ended(End.Deaf(decoder.finish()))
                break
            }
            val isFirst = decoder.pending == 0
            decoder.push(scratch, 0, read)
            if (growth > 0) settle()
            came(read, isFirst, now)
        }
        return budget
    }

    private fun roomFor(bytes: Long): Boolean {
        isStarved = !room(bytes)
        return !isStarved && !isOver
    }

    private fun decode(most: Int, now: Long): Int {
        var budget = most
        while (budget > 0 && !isOver && reads()) {
            val cost = decoder.cost()
            if (cost > 0 && !roomFor(cost)) break
            try {
                val frame = decoder.next() ?: return budget
                budget -= FRAME + frame.body.size
                arrived(frame, now)
            } catch (error: FrameError) {
                budget -= FRAME
                if (error.kind.isFatal) {
                    ended(End.Deaf(error))
                    return budget
                }
                skipped(error, now)
            }
        }
        return budget
    }

    /** Writes as many bytes as possible. Returns `true` if this emptied the queue. */
    private fun write(now: Long): Boolean {
        val before = unsent
        try {
            while (true) {
                gather()
                val first = out.firstOrNull() ?: break
                val taken = link.write(first, written, first.size - written)
                if (taken == 0) break
                written += taken
                unsent -= taken
                wrote(taken, now)
                if (written == first.size) {
                    out.removeFirst()
                    written = 0
                }
            }
        } catch (error: IOException) {
            ended(End.Broken(error))
        }
        return before > 0 && unsent == 0L
    }

    /** Joins short frames, so that they are sent with one write. */
    private fun gather() {
        var count = 0
        var length = 0
        for (frame in out) {
            if (length + frame.size > GATHERED) break
            length += frame.size
            count++
        }
        if (count < 2) return
        val all = ByteArray(length)
        var end = 0
        repeat(count) {
            val frame = out.removeFirst()
            frame.copyInto(all, end)
            end += frame.size
        }
        out.addFirst(all)
    }

    private fun arm(due: Long) {
        if (due == armed) return
        timer?.cancel()
        armed = due
        timer = if (due == Long.MAX_VALUE) null else loop.schedule(due) { armed = Long.MAX_VALUE; wake() }
    }

    /** Frees empty buffers. */
    fun tidy(): Unit = decoder.tidy()

    /** Closes the connection at once. */
    fun cut() {
        isOver = true
        timer?.cancel()
        link.close()
        closed()
    }

    /** Sends the rest, closes its half, and waits a moment for the end of the peer. */
    fun part() {
        if (isOver) return
        isOver = true
        timer?.cancel()
        timer = loop.schedule(loop.now + CLOSING) { cut() }
        wake()
    }

    private var saidGoodbye = false
    private var heardGoodbye = false

    private fun partWrites() {
        if (isClosed) return
        write(loop.now)
        try {
            if (unsent == 0L && !saidGoodbye) {
                saidGoodbye = true
                link.endOutput()
            }
            // Closing a socket with unread bytes resets it, and the peer loses bytes that it has not read yet.
            while (!heardGoodbye) {
                val read = link.read(scratch)
                if (read == 0) break
                heardGoodbye = read < 0
            }
            if (saidGoodbye && heardGoodbye) return cut()
            link.want(!heardGoodbye, unsent > 0)
        } catch (_: IOException) {
            cut()
        }
    }

    private var isClosed = false

    private fun closed() {
        if (isClosed) return
        isClosed = true
        out.clear()
        unsent = 0
        decoder.close()
        gone()
    }

    /** Called after the connection is closed. */
    protected open fun gone() {}

    private companion object {
        /** Most bytes to read and respond to in one turn. */
        const val TURN = 256 * 1024

        /** Cost of a frame in addition to its bytes. */
        const val FRAME = 2 * 1024
        const val READ = 16 * 1024

        /** Most bytes of frames that are joined into one write. Copying more would cost more than it saves. */
        const val GATHERED = 64 * 1024

        /** Time of a closing connection to send the rest and wait for the end of the peer, in milliseconds. */
        const val CLOSING = 1000L
    }
}
