package fc.runtime

import java.io.IOException
import kotlinx.coroutines.CancellableContinuation
import kotlinx.coroutines.channels.Channel

/** The received frames and errors for the app. The loop fills it, and any thread takes from it. */
internal class DataBox(private val life: Life, private val onRoom: () -> Unit) {
    /** A frame or an error. */
    sealed interface Item {
        val code: Int?

        class Frame(val frame: StreamFrame) : Item {
            override val code: Int get() = frame.code
        }

        class Fault(val error: DataError) : Item {
            override val code: Int? get() = (error.cause as? FrameError)?.frame?.code
        }
    }

    /** A queue for the frames of one code. It drops the oldest when it is full. */
    inner class Taker(val code: Int) {
        val waiting = ArrayDeque<Item>()
        var missed = 0L
        val signal = Channel<Unit>(Channel.CONFLATED)

        fun push(item: Item) {
            if (waiting.size >= QUEUE) {
                val oldest = waiting.indexOfFirst { it is Item.Frame }
                waiting.removeAt(maxOf(oldest, 0))
                missed++
            }
            waiting.addLast(item)
            signal.trySend(Unit)
        }

        suspend fun receive(): StreamFrame = take(signal) { waiting.removeFirstOrNull() }

        fun missed(): Long = synchronized(this@DataBox) { missed.also { missed = 0 } }

        fun leave() {
            synchronized(this@DataBox) { takers.remove(this) }
            signal.trySend(Unit)
        }
    }

    private val takers = ArrayList<Taker>()
    private var inbox: Item? = null
    private var gap: Loss? = null
    private var skipped = 0L
    private val signal = Channel<Unit>(Channel.CONFLATED)

    /** Returns `true` if the next frame fits. */
    @Synchronized
    fun hasRoom(): Boolean = takers.isNotEmpty() || (inbox == null && gap == null)

    @Synchronized
    fun put(item: Item) {
        val asked = takers.filter { it.code == item.code }
        asked.forEach { it.push(item) }
        if (asked.isNotEmpty()) return
        if (inbox != null || gap != null) {
            // Subscribers must not wait for a receiver that may never come.
            skipped++
            return
        }
        inbox = item
        signal.trySend(Unit)
    }

    @Synchronized
    fun lost(why: Loss) {
        gap = why
        for (taker in takers) {
            val last = (taker.waiting.lastOrNull() as? Item.Fault)?.error?.kind
            if (last != DataErrorKind.LOST) taker.push(Item.Fault(DataError(DataErrorKind.LOST, why)))
        }
        signal.trySend(Unit)
    }

    /** Wakes all receivers, for example after the end. */
    @Synchronized
    fun wake() {
        signal.trySend(Unit)
        takers.forEach { it.signal.trySend(Unit) }
    }

    @Synchronized
    fun skipped(): Long = skipped.also { skipped = 0 }

    fun enter(code: Int): Taker = synchronized(this) { Taker(code).also { takers.add(it) } }.also { onRoom() }

    suspend fun receive(): StreamFrame = take(signal) {
        val found = inbox ?: gap?.let { Item.Fault(DataError(DataErrorKind.LOST, it)) }
        if (inbox != null) inbox = null else gap = null
        found
    }

    private suspend fun take(signal: Channel<Unit>, next: () -> Item?): StreamFrame {
        while (true) {
            val closed = life.now as? ConnectionState.Closed
            when (val item = synchronized(this) { next() }) {
                is Item.Frame -> return item.frame.also { again(signal) }
                is Item.Fault -> {
                    again(signal)
                    throw item.error
                }
                null -> if (closed != null) {
                    signal.trySend(Unit)
                    throw DataError(DataErrorKind.CLOSED, closed.why)
                }
            }
            signal.receive()
        }
    }

    private fun again(signal: Channel<Unit>) {
        signal.trySend(Unit)
        onRoom()
    }

    private companion object {
        /** Most frames that wait for one subscriber. */
        const val QUEUE = 4
    }
}

/** An outgoing frame. */
internal class DataOut(val frame: ByteArray, val done: (DataError?) -> Unit) {
    var isBegun = false

    /** `true` if the sender has stopped waiting. */
    var isOrphan = false
    var timer: Timer? = null
}

/** The data connection of an app, without threads and sockets. It runs on the loop of the command connection. */
internal class DataCore(val commands: ClientCore, private val dial: Dial) {
    private val lines = Lines(commands.config.log, commands.protocol) { commands.loop.now }
    private val protocol = commands.protocol
    private val loop = commands.loop
    private val config = commands.config
    private val tries = Tries(config.reconnect)
    val life = Life()
    val box = DataBox(life) { loop.execute { line?.wake() } }
    private val encoder: Encoder = config.encoder(protocol)
    val patience: Long = config.callTimeout ?: protocol.defaults.callTimeout
    val limits: Limits get() = commands.limits
    private var line: Line? = null
    private var attempt: Timer? = null

    /** The number of the command connection that this one belongs to. */
    private var belongsTo = 0L

    /** `true` while it waits for a command connection. */
    private var isWaiting = false

    /** `true` if something was sent over this connection. */
    private var hasSent = false
    private var out: DataOut? = null

    /** The frame that waits behind an abandoned one. */
    private var next: DataOut? = null

    /** A loss after frames were sent, not yet reported to the sender. */
    private var unsure: Loss? = null

    fun execute(task: () -> Unit) = loop.execute(task)

    fun execute(waiting: CancellableContinuation<*>, task: () -> Unit) = loop.execute(waiting, task)

    fun enter(code: Int): DataBox.Taker {
        protocol.header.checkCode(code)
        return box.enter(code)
    }

    fun frame(code: Int, id: Long, data: ByteArray): ByteArray {
        protocol.header.checkCode(code)
        protocol.header.checkId(id)
        return encoder.prepare(data).frame(FrameId(false, protocol.streamKind, code, id))
    }

    fun begin() = loop.execute {
        commands.dependents.add(this)
        val now = commands.life.now
        if (now is ConnectionState.Closed) end(now.why) else connect()
    }

    /** Notes a new command connection. */
    fun commandsUp() {
        val line = line
        when {
            line != null && belongsTo != commands.life.now.connects -> lose(line, Loss.RENEWED, isUsed = true)
            isWaiting -> dialNow()
        }
    }

    fun close() = end(Loss.HERE)

    fun end(why: Loss) {
        if (life.now.isClosed) return
        commands.dependents.remove(this)
        attempt?.cancel()
        abandon(why)
        life.close(why)
        out?.takeIf { !it.isBegun }?.let { finish(it, DataError(DataErrorKind.CLOSED, why)) }
        line?.part()
        line = null
        box.wake()
    }

    private fun connect() {
        val wait = tries.next() ?: return end(life.now.why ?: Loss.NOT_YET)
        attempt = loop.schedule(after(loop.now, wait)) { dialNow() }
    }

    private fun dialNow() {
        isWaiting = !commands.life.now.isConnected
        if (isWaiting) return
        val number = commands.life.now.connects
        var isDone = false
        var limit: Timer? = null
        val dialling = dial.dial { link, failure ->
            isDone = true
            limit?.cancel()
            if (link != null) up(link, number) else failed(Loss.unreachable(failure ?: IOException("no connection")))
        }
        if (isDone) return
        limit = loop.schedule(after(loop.now, config.connectTimeout)) {
            dialling.cancel()
            failed(Loss.CONNECT_TIMEOUT)
        }
        attempt = object : Timer {
            override fun cancel() {
                limit.cancel()
                dialling.cancel()
            }
        }
    }

    private fun failed(why: Loss) {
        tries.failed()
        life.lost(why)
        connect()
    }

    private fun up(link: Link, number: Long) {
        if (life.now.isClosed) return link.close()
        val line = Line(link)
        this.line = line
        belongsTo = number
        hasSent = false
        line.start()
        life.connected()
        if (commands.life.now.connects != number) return lose(line, Loss.RENEWED, isUsed = true)
        out?.let { transmit(it) }
    }

    private fun lose(line: Line, why: Loss, isUsed: Boolean) {
        this.line = null
        line.cut()
        tries.connected(isUsed)
        abandon(why)
        box.lost(why)
        life.lost(why)
        connect()
    }

    /** Notes that sent frames may be lost. */
    private fun abandon(why: Loss) {
        val hadSent = hasSent
        hasSent = false
        val now = out
        when {
            now == null -> if (hadSent) unsure = why
            now.isOrphan -> {
                unsure = why
                finish(now, null)
            }
            now.isBegun || hadSent -> finish(now, DataError(DataErrorKind.LOST, why))
        }
    }

    // Sending.

    fun send(out: DataOut) {
        val now = life.now
        if (now is ConnectionState.Closed) return out.done(DataError(DataErrorKind.CLOSED, now.why))
        unsure?.let {
            unsure = null
            return out.done(DataError(DataErrorKind.LOST, it))
        }
        out.timer = loop.schedule(after(loop.now, patience)) { late(out) }
        if (this.out == null) take(out) else next = out
    }

    private fun take(out: DataOut) {
        this.out = out
        if (line != null) transmit(out)
    }

    private fun transmit(out: DataOut) {
        out.isBegun = true
        hasSent = true
        line?.send(out.frame)
    }

    /** Ends the wait for a connection. With a connection, the frame continues to wait for the robot to read. */
    private fun late(out: DataOut) {
        val now = life.now
        if (out.isBegun || now !is ConnectionState.Connecting) return
        finish(out, DataError(DataErrorKind.NOT_CONNECTED, now.why))
    }

    /** Abandons a frame. If it has begun, it is finished. */
    fun giveUp(out: DataOut) {
        if (out.isBegun) out.isOrphan = true else finish(out, null)
    }

    private fun finish(out: DataOut, error: DataError?) {
        out.timer?.cancel()
        if (next === out) next = null
        if (this.out === out) {
            this.out = null
            next?.let {
                next = null
                take(it)
            }
        }
        if (!out.isOrphan) out.done(error)
    }

    /** One connection. */
    private inner class Line(link: Link) : Conversation(loop, link, config.decoder(protocol)) {
        private val arriving = RateWatch(0, config.stallTimeout)
        private val leaving = RateWatch(0, config.stallTimeout)
        private var isHeard = false
        private var wasReading = true

        override fun reads(): Boolean = box.hasRoom()

        override fun came(bytes: Int, isFirst: Boolean, now: Long) {
            if (isFirst) arriving.begin(now) else arriving.add(bytes, now)
        }

        override fun begins(now: Long): Unit = leaving.begin(now)

        override fun failed(failure: Throwable): Unit = lines.failed("the data connection failed", failure)

        override fun wrote(bytes: Int, now: Long) {
            leaving.add(bytes, now)
            if (unsent == 0L) out?.takeIf { it.isBegun }?.let { finish(it, null) }
        }

        override fun tend(now: Long): Long {
            val isReading = reads()
            if (isReading && !wasReading) arriving.begin(now)
            wasReading = isReading
            val stalls = if (isReading && decoder.pending > 0) arriving.deadline else Long.MAX_VALUE
            val unread = if (unsent > 0) leaving.deadline else Long.MAX_VALUE
            if (stalls <= now) lose(Loss.stalled(decoder.pending, decoder.expected))
            else if (unread <= now) lose(Loss.UNREAD)
            return minOf(stalls, unread)
        }

        private fun lose(why: Loss): Unit = lose(this, why, isHeard || hasSent)

        override fun ended(end: End) = lose(
            when (end) {
                is End.Broken -> if (isHeard || end.isOwn) Loss.broken(end.cause) else Loss.UNHEARD
                is End.Deaf -> end.error?.let { Loss.frame(it) } ?: if (isHeard) Loss.CLOSED else Loss.UNHEARD
            },
        )

        override fun skipped(error: FrameError, now: Long) = put(DataBox.Item.Fault(DataError(DataErrorKind.FRAME, null, error)))

        override fun arrived(frame: Frame, now: Long) {
            arriving.begin(now)
            val id = frame.id
            if (id.kind != protocol.streamKind) return put(unexpected(id))
            if (!id.isResponse) return put(DataBox.Item.Frame(StreamFrame(id.code, id.id, frame.body)))
            val refusal = try {
                val read = Bodies.enveloped(protocol.responseEnvelope, Empty, frame.body, limits.json())
                Envelopes.refusal(protocol, read.envelope)
            } catch (_: BodyError) {
                null
            }
            put(if (refusal == null) unexpected(id) else DataBox.Item.Fault(DataError(DataErrorKind.REFUSED, null, refusal)))
        }

        private fun unexpected(id: FrameId) = DataBox.Item.Fault(DataError(DataErrorKind.UNEXPECTED, null, null, "the $id"))

        private fun put(item: DataBox.Item) {
            isHeard = true
            box.put(item)
        }
    }
}
