package fc.runtime

import java.net.SocketAddress
import kotlinx.coroutines.channels.Channel
import kotlinx.coroutines.flow.Flow
import kotlinx.coroutines.flow.flow

/** A frame of raw bytes from an app. */
public class AppStream internal constructor(
    /** The data connection of the frame, for [Audience.one]. */
    public val connection: Long,
    /** Address of the app; `null` for a connection without an address. */
    public val peer: SocketAddress?,
    /** The frame. */
    public val frame: StreamFrame,
) {
    internal val bytes: Long get() = frame.data.size.toLong()
}

/** The frames of raw bytes from apps, in the order received on each connection. */
public class AppStreams internal constructor(private val inbox: StreamInbox, private val generation: Int) : AutoCloseable {
    /** Returns the next frame, or `null` after the end of the server or after another receiver took over. */
    @JvmSynthetic
    public suspend fun receive(): AppStream? = inbox.receive(generation)

    /** The frames as a flow. It ends like [receive]. */
    public fun asFlow(): Flow<AppStream> = flow { while (true) emit(receive() ?: break) }

    /** Takes no more frames. From now on they are dropped. */
    override fun close(): Unit = inbox.leave(generation)
}

/** A short queue of frames from apps for one receiver. The loop fills it, and any thread takes from it. */
internal class StreamInbox(private val mostBytes: Long, private val onRoom: () -> Unit) {
    private val waiting = ArrayDeque<AppStream>()

    /** Bytes of the queued frames. */
    @Volatile
    var bytes = 0L
        private set
    private var generation = 0
    private var isTaken = false
    private var isOver = false
    private val signal = Channel<Unit>(Channel.CONFLATED)

    @Synchronized
    fun enter(): Int {
        isTaken = true
        signal.trySend(Unit)
        return ++generation
    }

    fun leave(receiver: Int) {
        synchronized(this) {
            if (receiver != generation) return
            isTaken = false
            waiting.clear()
            bytes = 0
        }
        signal.trySend(Unit)
        onRoom()
    }

    /** Returns `true` if a frame can be queued, or dropped without a receiver. */
    @Synchronized
    fun hasRoom(): Boolean = !isTaken || waiting.size < QUEUE && (waiting.isEmpty() || bytes < mostBytes)

    /** Bytes of the queued frames of one connection. */
    @Synchronized
    fun bytesOf(connection: Long): Long = waiting.sumOf { if (it.connection == connection) it.bytes else 0L }

    /** Drops the frames of one connection. */
    @Synchronized
    fun drop(connection: Long) {
        bytes -= bytesOf(connection)
        waiting.removeAll { it.connection == connection }
    }

    /** Queues a frame. Returns `false` if there is no receiver. */
    @Synchronized
    fun put(frame: AppStream): Boolean {
        if (!isTaken) return false
        waiting.addLast(frame)
        bytes += frame.bytes
        signal.trySend(Unit)
        return true
    }

    @Synchronized
    fun end() {
        isOver = true
        signal.trySend(Unit)
    }

    suspend fun receive(receiver: Int): AppStream? {
        while (true) {
            val found = synchronized(this) {
                val isEnded = receiver != generation || !isTaken
                val frame = if (isEnded) null else waiting.removeFirstOrNull()
                bytes -= frame?.bytes ?: 0L
                if (frame == null && (isEnded || isOver)) {
                    signal.trySend(Unit)
                    return null
                }
                frame
            }
            if (found != null) {
                signal.trySend(Unit)
                onRoom()
                return found
            }
            signal.receive()
        }
    }

    private companion object {
        const val QUEUE = 4
    }
}

/** The data connection of one app to a robot. */
internal class DataPeer(private val server: ServerCore, link: Link, val id: Long, val address: SocketAddress?) :
    Conversation(server.loop, link, server.config.decoder(server.protocol)), MemoryHolder {
    /** A frame that waits for space in the queue, with the callback for its outcome. */
    private class Out(val frame: ByteArray, val queued: (Boolean) -> Unit, val timer: Timer?)

    private val config = server.config
    private val protocol = server.protocol
    private val queue = ArrayDeque<ByteArray>()
    private val waiting = ArrayDeque<Out>()

    /** Bytes of the frames in the queue. */
    private var queuedBytes = 0L
    private var isDraining = false
    private var isDeaf = false
    private var headerSince = -1L
    private val arriving = RateWatch(config.leastRate, config.stallTimeout)
    private val leaving = RateWatch(config.leastRate, config.stallTimeout)
    private val pace = Pace()
    private var wasReading = true

    /** The command connection that it belongs to, `NOBODY` or `SEVERAL`. */
    var owner = NOBODY
        private set

    /** `true` once a frame has been received. */
    var isHeard = false
        private set

    /** Notes a command connection from the same address. */
    fun saw(app: Long) {
        owner = if (owner == NOBODY || owner == app) app else SEVERAL
    }

    /** Queues a frame as soon as there is space, within the stall timeout. [queued] gets `false` otherwise. */
    fun offer(frame: ByteArray, queued: (Boolean) -> Unit) {
        if (isOver || isDraining) return queued(false)
        if (waiting.isEmpty() && hasPlace(frame)) {
            enqueue(frame)
            return queued(true)
        }
        var out: Out? = null
        val timer = loop.schedule(after(loop.now, config.stallTimeout)) { if (waiting.remove(out)) queued(false) }
        out = Out(frame, queued, timer)
        waiting.addLast(out)
    }

    /** Returns `true` if a frame can be queued. Frames that wait for memory close no connection. */
    private fun hasPlace(frame: ByteArray): Boolean {
        if (queue.size >= QUEUE) return false
        val hasRoom = server.memory.hasRoom(frame.size.toLong())
        if (!hasRoom) server.memory.await(this)
        return hasRoom
    }

    private fun enqueue(frame: ByteArray) {
        queue.addLast(frame)
        queuedBytes += frame.size
        settle()
        wake()
    }

    override val held: Long get() = decoder.capacity + unsent + queuedBytes
    override val weight: Long get() = held + server.inbox.bytesOf(id)
    override var counted = 0L

    override fun room(bytes: Long): Boolean = server.memory.room(this, bytes)

    override fun settle() {
        if (!isOver) server.memory.settle(this)
    }

    override fun failed(failure: Throwable): Unit = server.lines.failed("a data connection failed", failure)

    override fun reads(): Boolean = !isDraining && !isDeaf && server.inbox.hasRoom() && pace.until <= loop.now

    override fun came(bytes: Int, isFirst: Boolean, now: Long) {
        server.counting.add(ServerCount.BYTES_IN, bytes.toLong())
        if (isFirst) arriving.begin(now) else arriving.add(bytes, now)
    }

    override fun begins(now: Long): Unit = leaving.begin(now)

    override fun wrote(bytes: Int, now: Long): Unit = leaving.add(bytes, now)

    override fun sent(bytes: Int): Unit = server.counting.add(ServerCount.BYTES_OUT, bytes.toLong())

    override fun arrived(frame: Frame, now: Long) {
        headerSince = -1
        arriving.begin(now)
        rests(pace.inflated(decoder.takeSurplus(), now))
        val id = frame.id
        if (id.kind != protocol.streamKind) {
            server.counting.add(ServerCount.BAD_FRAMES)
            rests(pace.unusable(now))
            if (!id.isResponse) refuse(id)
            return
        }
        isHeard = true
        // A response of an app to a stream frame is only counted.
        if (id.isResponse) return
        server.counting.add(ServerCount.STREAM_FRAMES_IN)
        val stream = AppStream(this.id, address, StreamFrame(id.code, id.id, frame.body))
        if (!server.inbox.put(stream)) server.counting.add(ServerCount.STREAM_FRAMES_DROPPED)
    }

    override fun skipped(error: FrameError, now: Long) {
        headerSince = -1
        server.counting.add(ServerCount.BAD_FRAMES)
        rests(pace.unusable(now))
        error.frame?.takeIf { !it.isResponse }?.let { refuse(it) }
    }

    private fun rests(doesRest: Boolean) {
        if (doesRest) server.counting.add(ServerCount.CONNECTIONS_PACED)
    }

    /** Refuses an unusable frame. Without space in the queue, the refusal is dropped. */
    private fun refuse(id: FrameId) {
        if (!Envelopes.hasResult(protocol) || queue.size >= QUEUE) return
        val result = protocol.results.protocol
        val envelope = Envelopes.response(protocol, System.currentTimeMillis(), result.code, result.text)
        try {
            enqueue(server.encoder.prepare(Bodies.write(envelope, Empty.INSTANCE)).frame(id.answer()))
        } catch (_: FrameError) {
            // An envelope alone fits into any reasonable frame limit.
        }
    }

    override fun ended(end: End) {
        if (end is End.Broken) return goAtOnce()
        if ((end as End.Deaf).error != null) server.counting.add(ServerCount.BAD_FRAMES)
        isDeaf = true
    }

    override fun tend(now: Long): Long {
        while (unsent == 0L && !isOver) {
            val frame = queue.removeFirstOrNull() ?: break
            queuedBytes -= frame.size
            send(frame)
            server.counting.add(ServerCount.STREAM_FRAMES_OUT)
            letIn()
        }
        letIn()
        if (isOver) return Long.MAX_VALUE
        val isReading = reads() && !isStarved
        if (isReading && !wasReading) arriving.begin(now)
        wasReading = isReading
        headerSince = if (!decoder.isInsideHeader) -1 else if (headerSince < 0) now else headerSince
        val header = if (headerSince >= 0 && isReading) after(headerSince, config.headerTimeout) else Long.MAX_VALUE
        val stalls = if (isReading && decoder.pending > 0) arriving.deadline else Long.MAX_VALUE
        val unread = if (unsent > 0) leaving.deadline else Long.MAX_VALUE
        val late = minOf(header, minOf(stalls, unread))
        val due = if (pace.until > now) minOf(late, pace.until) else late
        if (late <= now) {
            server.counting.add(ServerCount.CONNECTIONS_TIMED_OUT)
            goAtOnce()
        } else if ((isDraining || isDeaf) && queue.isEmpty() && unsent == 0L) {
            goPolitely()
        }
        return due
    }

    /** Queues waiting frames while there is space. */
    private fun letIn() {
        while (!isOver) {
            val next = waiting.firstOrNull()?.takeIf { hasPlace(it.frame) } ?: return
            waiting.removeFirst()
            next.timer?.cancel()
            enqueue(next.frame)
            next.queued(true)
        }
    }

    /** Ends after the queued frames are sent. */
    fun drain() {
        isDraining = true
        wake()
    }

    private fun goAtOnce() {
        cut()
        server.leave(this)
    }

    private fun goPolitely() {
        if (isOver) return
        server.parts()
        isParting = true
        part()
        server.leave(this)
    }

    private var isParting = false

    override fun gone() {
        if (isParting) server.gone() else server.leave(this)
    }

    fun left() {
        val left = waiting.toList()
        waiting.clear()
        for (out in left) {
            out.timer?.cancel()
            out.queued(false)
        }
    }

    internal companion object {
        const val NOBODY = 0L
        const val SEVERAL = -1L

        /** Most frames that wait for one app, in addition to the current one. */
        const val QUEUE = 4
    }
}
