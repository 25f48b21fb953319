package fc.runtime

import java.io.ByteArrayOutputStream
import java.io.IOException
import java.util.PriorityQueue

/** A loop with a clock of the test. It runs only on request. */
internal class TestLoop : Loop {
    private class Alarm(val at: Long, val order: Int, var task: (() -> Unit)?) : Timer, Comparable<Alarm> {
        override fun compareTo(other: Alarm): Int = compareValuesBy(this, other, { it.at }, { it.order })

        override fun cancel() {
            task = null
        }
    }

    private val tasks = ArrayDeque<() -> Unit>()
    private val timers = PriorityQueue<Alarm>()
    private var order = 0
    override var now = 1_000_000L
        private set

    override fun execute(task: () -> Unit) {
        tasks.addLast(task)
    }

    override fun schedule(at: Long, task: () -> Unit): Timer = Alarm(at, order++, task).also { timers.add(it) }

    /** Runs everything that is possible without more time. */
    fun settle() {
        var turns = 0
        while (true) {
            if (++turns > 100_000) throw Wrong("it never comes to rest")
            val due = timers.peek()?.takeIf { it.at <= now }
            when {
                tasks.isNotEmpty() -> tasks.removeFirst()()
                due != null -> {
                    timers.poll()
                    due.task?.invoke()
                }
                else -> return
            }
        }
    }

    fun advance(milliseconds: Long) {
        now += milliseconds
        settle()
    }
}

/** The link of a peer under test. The test is the other end. */
internal class TestLink(private val loop: TestLoop) : Link {
    private var incoming = ArrayDeque<ByteArray>()
    private var ready: (() -> Unit)? = null
    private var wantsRead = false
    private var wantsWrite = false

    /** The bytes from the peer. */
    val outgoing = ByteArrayOutputStream()

    /** Number of writes of the peer. */
    var writes = 0
        private set

    /** `true` once the test has disconnected. */
    private var isLost = false

    /** `true` once the test has closed its half. */
    private var isEnded = false

    /** Number of bytes that the test takes. */
    var room = Int.MAX_VALUE
        set(value) {
            field = value
            call()
        }

    /** `true` once the peer has closed its half or the connection. */
    var hasGone = false
        private set
    var isClosed = false
        private set

    fun give(bytes: ByteArray) {
        incoming.addLast(bytes)
        call()
    }

    fun lose() {
        isLost = true
        incoming.clear()
        call()
    }

    /** Closes the half of the test, and reads on. */
    fun end() {
        isEnded = true
        call()
    }

    private fun call() {
        val isReadable = incoming.isNotEmpty() || isLost || isEnded
        if ((wantsRead && isReadable) || (wantsWrite && (room > 0 || isLost))) {
            wantsRead = false
            wantsWrite = false
            loop.execute { ready?.invoke() }
        }
    }

    override fun open(ready: () -> Unit) {
        this.ready = ready
    }

    override fun read(into: ByteArray): Int {
        if (isClosed) throw IOException("closed")
        val first = incoming.removeFirstOrNull() ?: return if (isLost || isEnded) -1 else 0
        val length = minOf(first.size, into.size)
        first.copyInto(into, 0, 0, length)
        if (length < first.size) incoming.addFirst(first.copyOfRange(length, first.size))
        return length
    }

    override fun write(bytes: ByteArray, from: Int, length: Int): Int {
        if (isLost || isClosed) throw IOException("broken pipe")
        val taken = minOf(length, room)
        if (taken > 0) writes++
        outgoing.write(bytes, from, taken)
        if (room != Int.MAX_VALUE) room -= taken
        return taken
    }

    override fun want(read: Boolean, write: Boolean) {
        wantsRead = read
        wantsWrite = write
        call()
    }

    override fun endOutput() {
        hasGone = true
    }

    override fun close() {
        hasGone = true
        isClosed = true
    }
}

/** Frames at the end of the test. */
internal class TestWire(loop: TestLoop) {
    val link = TestLink(loop)
    private val decoder = Decoder(Toy, Toy.defaults.limits)

    fun send(frame: FrameId, body: String) = link.give(bytes(frame, body.toByteArray()))

    /** Returns the frames from the peer since the last call. */
    fun frames(): List<Frame> {
        val bytes = link.outgoing.toByteArray()
        link.outgoing.reset()
        decoder.push(bytes, 0, bytes.size)
        return generateSequence { decoder.next() }.toList()
    }

    companion object {
        fun bytes(frame: FrameId, body: ByteArray): ByteArray = Encoder(Toy, 1L shl 30, null).prepare(body).frame(frame)
    }
}
