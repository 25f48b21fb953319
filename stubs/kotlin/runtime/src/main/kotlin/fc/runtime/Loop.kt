package fc.runtime

import java.io.IOException
import kotlin.coroutines.resumeWithException
import kotlinx.coroutines.CancellableContinuation

/** One thread's turns, and its clock. Whatever belongs to a connection happens on its loop. */
internal interface Loop {
    /** The time in milliseconds, of no calendar. */
    val now: Long

    /** Runs a task on the loop, after those before it. From any thread. */
    fun execute(task: () -> Unit)

    /** Runs a task at a time. On the loop alone. */
    fun schedule(at: Long, task: () -> Unit): Timer
}

/** Runs a task on the loop for a coroutine that waits. It gets the exception that the task throws. */
internal fun Loop.execute(waiting: CancellableContinuation<*>, task: () -> Unit) = execute {
    try {
        task()
    } catch (failure: Throwable) {
        if (waiting.isActive) waiting.resumeWithException(failure)
    }
}

/** A task that runs at a time, unless it is cancelled before. */
internal interface Timer {
    fun cancel()
}

/** A connection's bytes. No method waits; all are called on the loop. */
internal interface Link {
    /** Begins: [ready] is called on the loop when what was asked for by [want] can be done. */
    fun open(ready: () -> Unit)

    /** Reads what is there: how many bytes; 0 if there are none yet, -1 if there will be none. */
    @Throws(IOException::class)
    fun read(into: ByteArray): Int

    /** Writes what can be taken now, and gives how many bytes that was. */
    @Throws(IOException::class)
    fun write(bytes: ByteArray, from: Int, length: Int): Int

    /** What to call back for. */
    fun want(read: Boolean, write: Boolean)

    /** Tells the peer that nothing more comes. */
    @Throws(IOException::class)
    fun endOutput()

    /** Ends both directions. */
    fun close()
}

/** Makes a connection, each time it is asked to; calls back on the loop. */
internal fun interface Dial {
    /** Begins to connect. The result cancels it. */
    fun dial(done: (Link?, Exception?) -> Unit): Timer
}

/** What has come to its end on a connection. */
internal sealed interface End {
    /** Nothing can be sent either. */
    class Broken(
        val cause: IOException,
        /** The runtime has failed, and not the network. */
        val isOwn: Boolean = false,
    ) : End

    /** The peer sends nothing more, or what it sends cannot be told into frames. */
    class Deaf(val error: FrameError?) : End
}

/**
 * One connection: reads frames, writes frames, and knows when to go on. What it does all belongs to one turn, which is
 * taken when something can be read or written, when something is due, or when somebody [wakes][wake] it. On the loop alone.
 */
internal abstract class Conversation(protected val loop: Loop, private val link: Link, protected val decoder: Decoder) {
    private val out = ArrayDeque<ByteArray>()
    private var written = 0
    private val scratch = ByteArray(READ)
    private var isWoken = false
    private var timer: Timer? = null
    private var armed = Long.MAX_VALUE

    /** Nothing more is dealt with; it may still be saying goodbye. */
    var isOver = false
        private set

    /** Bytes that the peer has not taken yet. */
    var unsent = 0L
        private set

    fun start() {
        link.open { wake() }
        wake()
    }

    /** Takes a turn soon. */
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

    /** A turn has failed: the connection ends, and harms no other. */
    private fun end(failure: Throwable) {
        failed(failure)
        try {
            if (!isOver) ended(End.Broken(IOException(failure), isOwn = true))
        } finally {
            cut()
        }
    }

    /** Sends a frame with the next turn. A long body is not copied. */
    fun send(body: Prepared, id: FrameId): Unit =
        if (body.length <= GATHERED) send(body.frame(id)) else send(body.header(id), body.data)

    /** Sends a frame with the next turn, in one piece or two. */
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

    /** Whether more is read at this moment. */
    protected abstract fun reads(): Boolean

    /** A frame has come. */
    protected abstract fun arrived(frame: Frame, now: Long)

    /** One has come that could not be read, and was skipped. */
    protected abstract fun skipped(error: FrameError, now: Long)

    /** Bytes have come, of which [isFirst] are the first of a frame. */
    protected abstract fun came(bytes: Int, isFirst: Boolean, now: Long)

    /** Something ends. */
    protected abstract fun ended(end: End)

    /** Does all that is due, and says when it has to be asked again at the latest. */
    protected abstract fun tend(now: Long): Long

    /** Something is to be sent, and there was nothing before. */
    protected abstract fun begins(now: Long)

    /** The peer has taken so many bytes. */
    protected abstract fun wrote(bytes: Int, now: Long)

    /** So many bytes have been handed over to be sent. */
    protected open fun sent(bytes: Int) {}

    /** A turn has failed with an exception. */
    protected abstract fun failed(failure: Throwable)

    /** Makes room for so many more bytes. `false` if there is none: the conversation is woken when there may be. */
    protected open fun room(bytes: Long): Boolean = true

    /** The bytes that it holds have changed. */
    protected open fun settle() {}

    /** Reading waits for memory. */
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

    /** Reads and deals with all there is, or as much as one turn may. What is left of that. */
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

    /** Writes what can be taken; whether that was all and there was something. */
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

    /** Puts short frames together, which go out with one write. */
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

    /** Gives back memory that nothing is in. */
    fun tidy(): Unit = decoder.tidy()

    /** Ends at once. */
    fun cut() {
        isOver = true
        timer?.cancel()
        link.close()
        closed()
    }

    /** Sends what is left, says goodbye, and waits a moment for the peer's own. */
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
            // A socket that is closed while something is unread is reset, and what the peer has not read is lost to it.
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

    /** The connection is no more. */
    protected open fun gone() {}

    private companion object {
        /** What may be read and answered in one turn, in bytes. */
        const val TURN = 256 * 1024

        /** What the work on a frame counts beside its bytes. */
        const val FRAME = 2 * 1024
        const val READ = 16 * 1024

        /** Up to how many bytes frames go out with one write: copying more would cost more than it saves. */
        const val GATHERED = 64 * 1024

        /** How long a closing connection tries to send what is left, and waits for the peer's goodbye. */
        const val CLOSING = 1000L
    }
}
