package fc.runtime

import java.util.concurrent.CompletableFuture
import kotlin.coroutines.resume
import kotlin.coroutines.resumeWithException
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.flow.Flow
import kotlinx.coroutines.flow.flow
import kotlinx.coroutines.future.future
import kotlinx.coroutines.suspendCancellableCoroutine
import kotlinx.coroutines.sync.Mutex
import kotlinx.coroutines.sync.withLock
import kotlinx.coroutines.withTimeoutOrNull

/** A frame of raw bytes. */
public class StreamFrame internal constructor(
    /** Command code: what the bytes belong to. */
    public val code: Int,
    /** Message id, that of the request which they answer or prepare. */
    public val id: Long,
    /** The bytes. They are the receiver's own. */
    public val data: ByteArray,
) {
    override fun toString(): String = "StreamFrame(code=$code, id=$id, ${data.size} bytes)"
}

/** What can go wrong at the data port. */
public enum class DataErrorKind {
    /** The connection was lost: frames may be missing here, or may not have arrived. */
    LOST,

    /** No connection in time; nothing was sent. */
    NOT_CONNECTED,

    /** The connection has ended for good. */
    CLOSED,

    /** A frame could not be read, or does not fit. */
    FRAME,

    /** The robot has refused a frame. */
    REFUSED,

    /** A frame arrived that does not belong on this port. */
    UNEXPECTED,

    /** What a frame carries is not JSON as its stream says, or breaks a constraint. */
    INVALID,
}

/** Why there is no frame here. */
public class DataError internal constructor(
    /** What went wrong. */
    public val kind: DataErrorKind,
    /** Why there is no connection, if that is what is wrong. */
    public val loss: Loss?,
    cause: Exception? = null,
    private val detail: String = "",
) : Exception(null, cause) {
    /** The error's fixed name. */
    public val name: String
        get() = when (kind) {
            DataErrorKind.LOST -> "lost"
            DataErrorKind.NOT_CONNECTED -> "not_connected"
            DataErrorKind.CLOSED -> "closed"
            DataErrorKind.REFUSED -> "refused"
            DataErrorKind.UNEXPECTED -> "unexpected_frame"
            DataErrorKind.FRAME, DataErrorKind.INVALID -> (cause as? FrameError)?.name ?: (cause as? BodyError)?.name ?: "frame"
        }

    override val message: String get() = listOf(name, loss?.toString() ?: cause?.message ?: detail).joinToString(": ")
}

/**
 * A connection to a robot's data port: frames of raw bytes in both directions.
 *
 * It is made in the background as soon as the command connection is there, made again after a loss and whenever the command
 * connection was, and ends with it. The protocol has no acknowledgement for such frames: what was on its way when the
 * connection was lost may have arrived or not, and each loss is told once to the receiver, and once to the sender if anything
 * was sent. Nothing is queued but one frame either way, unless something is [subscribed][subscribe] to.
 */
public class DataConnection internal constructor(private val core: DataCore) : AutoCloseable {
    /** One frame is sent at a time. */
    private val turn = Mutex()

    /**
     * Waits until there is a connection, for no longer than the call timeout. Wait for it before asking the robot for what it
     * sends over the data port.
     *
     * @throws DataError not connected, or closed
     */
    @JvmSynthetic
    public suspend fun connected() {
        withTimeoutOrNull(core.patience) { core.life.settled() }
        when (val now = state) {
            is ConnectionState.Connected -> Unit
            is ConnectionState.Connecting -> throw DataError(DataErrorKind.NOT_CONNECTED, now.why)
            is ConnectionState.Closed -> throw DataError(DataErrorKind.CLOSED, now.why)
        }
    }

    /**
     * The next frame. As long as the app does not take what has arrived, the robot is not read.
     *
     * @throws DataError unless it says closed, the next call goes on with the next frame
     */
    @JvmSynthetic
    public suspend fun receive(): StreamFrame = core.box.receive()

    /** [receive] for Java. */
    public fun receiveAsync(): CompletableFuture<StreamFrame> = SCOPE.future { receive() }

    /**
     * The frames of one stream from now on, in a queue of four of which the oldest makes way; they no longer come to
     * [receive].
     */
    public fun subscribe(code: Int): Subscription<ByteArray> = Subscription(core.enter(code)) { it }

    /** The same of a stream that carries JSON: each frame is read as a message. */
    public fun <M : Message> subscribe(code: Int, type: MessageType<M>): Subscription<M> =
        Subscription(core.enter(code)) { data ->
            try {
                Bodies.decode(type, data, core.limits.json())
            } catch (error: BodyError) {
                throw DataError(DataErrorKind.INVALID, null, error)
            }
        }

    /** How many frames to which nobody had subscribed have been dropped since this was last asked. */
    public fun missed(): Long = core.box.skipped()

    /**
     * Sends a frame of raw bytes: [code] says what they belong to, [id] which request they answer or prepare. Returns when the
     * socket has taken it. Without a connection it waits for one, for no longer than the call timeout.
     *
     * @throws DataError lost: send again from where the robot can go on; otherwise nothing was sent
     */
    @JvmSynthetic
    public suspend fun send(code: Int, id: Long, data: ByteArray): Unit = turn.withLock {
        val frame = try {
            core.frame(code, id, data)
        } catch (error: FrameError) {
            throw DataError(DataErrorKind.FRAME, null, error)
        }
        suspendCancellableCoroutine { waiting ->
            val out = DataOut(frame) { error -> if (error == null) waiting.resume(Unit) else waiting.resumeWithException(error) }
            waiting.invokeOnCancellation { core.execute { core.giveUp(out) } }
            core.execute(waiting) { if (waiting.isActive) core.send(out) }
        }
    }

    /** Sends a frame with a JSON object, without an envelope; all else is as with bytes. */
    @JvmSynthetic
    public suspend fun send(code: Int, id: Long, content: Message) {
        try {
            content.check()
        } catch (error: BodyError) {
            throw DataError(DataErrorKind.INVALID, null, error)
        }
        send(code, id, content.toJson().text.toByteArray())
    }

    /** [send] for Java. */
    public fun sendAsync(code: Int, id: Long, data: ByteArray): CompletableFuture<Void?> = SCOPE.future {
        send(code, id, data)
        null
    }

    /** Whether there is a connection at this moment, and why not. */
    public val state: ConnectionState get() = core.life.now

    /** The states of the connection: the present one first, then each that it comes to. */
    public fun states(): Flow<ConnectionState> = core.life.states

    /** Waits until the connection has ended for good, and says why. */
    @JvmSynthetic
    public suspend fun closed(): Loss = core.life.closed()

    /** Closes the connection. A frame that is being sent is finished, if the robot takes it within a second. */
    override fun close(): Unit = core.execute { core.close() }

    private companion object {
        /** Where what Java has asked for goes on. */
        val SCOPE = CoroutineScope(SupervisorJob() + Dispatchers.Default)
    }
}

/** The frames of one stream from the receiver's creation on, each read as a [T]. Close it when it is not needed any more. */
public class Subscription<T : Any> internal constructor(
    private val taker: DataBox.Taker,
    private val read: (ByteArray) -> T,
) : AutoCloseable {
    /**
     * The next frame.
     *
     * @throws DataError unless it says closed, the next call goes on with the next frame
     */
    @JvmSynthetic
    public suspend fun receive(): StreamItem<T> = taker.receive().let { StreamItem(it.id, read(it.data)) }

    /** The frames as a flow, which fails as [receive] does. */
    public fun asFlow(): Flow<StreamItem<T>> = flow { while (true) emit(receive()) }

    /** How many frames have made way for later ones since this was last asked. */
    public fun missed(): Long = taker.missed()

    /** Takes no more frames. */
    override fun close(): Unit = taker.leave()
}

/** A frame of a stream, read. */
public class StreamItem<T : Any> internal constructor(
    /** Message id, that of the request which it belongs to. */
    public val id: Long,
    /** What it carries. */
    public val content: T,
)
