package fc.runtime

import java.util.concurrent.CompletableFuture
import java.util.function.Consumer
import kotlin.coroutines.resume
import kotlin.coroutines.resumeWithException
import kotlinx.coroutines.flow.Flow
import kotlinx.coroutines.flow.flow
import kotlinx.coroutines.suspendCancellableCoroutine
import kotlinx.coroutines.sync.Mutex
import kotlinx.coroutines.sync.withLock
import kotlinx.coroutines.withTimeoutOrNull

/** A frame of raw bytes. */
public class StreamFrame internal constructor(
    /** Command code of the stream. */
    public val code: Int,
    /** Message id of the request that the bytes belong to. */
    public val id: Long,
    /** The bytes. The receiver owns the array. */
    public val data: ByteArray,
) {
    override fun toString(): String = "StreamFrame(code=$code, id=$id, ${data.size} bytes)"
}

/** The kind of an error at the data port. */
public enum class DataErrorKind {
    /** The connection was lost. Frames may be missing on either side. */
    LOST,

    /** No connection in time; nothing was sent. */
    NOT_CONNECTED,

    /** The connection has ended for good. */
    CLOSED,

    /** A frame is broken, or the data does not fit into one. */
    FRAME,

    /** The robot has refused a frame. */
    REFUSED,

    /** A frame arrived that does not belong to this port. */
    UNEXPECTED,

    /** The content of a frame is not JSON as specified, or breaks a constraint. */
    INVALID,
}

/** The error of a failed receive or send. */
public class DataError internal constructor(
    /** The kind of the error. */
    public val kind: DataErrorKind,
    /** The reason of the loss, if any. */
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
 * A connection to the data port of a robot: frames of raw bytes in both directions. It follows the command connection:
 * it connects in the background, reconnects after a loss of either, and ends with the command connection.
 *
 * The protocol has no acknowledgement for these frames, so frames in transit may be lost with the connection. The
 * receiver gets an error for each loss, and so does the sender if it has sent something. Each direction queues one
 * frame, except for [subscriptions][subscribe].
 */
public class DataConnection internal constructor(private val core: DataCore) : AutoCloseable {
    /** Lets one caller send at a time. */
    private val turn = Mutex()

    /**
     * Waits until the connection is up, at most for the call timeout. Wait for it before you request data over the data
     * port.
     *
     * @throws DataError if it is not connected in time, or closed
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

    /** [connected] for Java. */
    public fun connectedAsync(): CompletableFuture<Void?> = Futures.done { connected() }

    /**
     * Returns the next frame. While the app does not take received frames, the client stops reading from the robot.
     *
     * @throws DataError on an error; unless it is `closed`, the next call continues with the next frame
     */
    @JvmSynthetic
    public suspend fun receive(): StreamFrame = core.box.receive()

    /** [receive] for Java. */
    public fun receiveAsync(): CompletableFuture<StreamFrame> = Futures.of { receive() }

    /**
     * Returns the frames of one stream from now on. [receive] then skips them. The queue holds four frames, and drops
     * the oldest when it is full.
     */
    public fun subscribe(code: Int): Subscription<ByteArray> = Subscription(core.enter(code)) { it }

    /** Returns the frames of a stream of JSON, each read as a message. */
    public fun <M : Message> subscribe(code: Int, type: MessageType<M>): Subscription<M> =
        Subscription(core.enter(code)) { data ->
            try {
                Bodies.decode(type, data, core.limits.json())
            } catch (error: BodyError) {
                throw DataError(DataErrorKind.INVALID, null, error)
            }
        }

    /** Returns the number of dropped frames without a subscription since the last call. */
    public fun missed(): Long = core.box.skipped()

    /**
     * Sends a frame of raw bytes, and waits until the socket has accepted it. [code] is the stream, [id] the request
     * that the bytes belong to. Without a connection it waits for one, at most for the call timeout.
     *
     * @throws DataError if it fails; after `lost`, send again from a point where the robot can continue; otherwise
     *     nothing was sent
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

    /** Sends a frame with a JSON object, without an envelope, like one with raw bytes. */
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
    public fun sendAsync(code: Int, id: Long, data: ByteArray): CompletableFuture<Void?> = Futures.done {
        send(code, id, data)
    }

    /** [send] for Java. */
    public fun sendAsync(code: Int, id: Long, content: Message): CompletableFuture<Void?> = Futures.done {
        send(code, id, content)
    }

    /** The current state of the connection. */
    public val state: ConnectionState get() = core.life.now

    /** The states of the connection, from the current one to the last. */
    public fun states(): Flow<ConnectionState> = core.life.states

    /**
     * Calls [listener] with the current state and each later one, until the result is closed. For Java. An exception of
     * the listener is logged, and the next state still reaches it.
     */
    public fun onState(listener: Consumer<ConnectionState>): AutoCloseable = core.commands.watch(core.life, listener)

    /** Waits until the connection has ended for good, and returns the reason. */
    @JvmSynthetic
    public suspend fun closed(): Loss = core.life.closed()

    /** [closed] for Java. */
    public fun closedAsync(): CompletableFuture<Loss> = Futures.of { closed() }

    /** Closes the connection. A frame that is being sent is finished if the robot takes it within a second. */
    override fun close(): Unit = core.execute { core.close() }
}

/** The frames of one stream since the subscription, each read as a [T]. Close it after use. */
public class Subscription<T : Any> internal constructor(
    private val taker: DataBox.Taker,
    private val read: (ByteArray) -> T,
) : AutoCloseable {
    /**
     * Returns the next frame.
     *
     * @throws DataError on an error; unless it is `closed`, the next call continues with the next frame
     */
    @JvmSynthetic
    public suspend fun receive(): StreamItem<T> = taker.receive().let { StreamItem(it.id, read(it.data)) }

    /** [receive] for Java. */
    public fun receiveAsync(): CompletableFuture<StreamItem<T>> = Futures.of { receive() }

    /** The frames as a flow. It fails like [receive]. */
    public fun asFlow(): Flow<StreamItem<T>> = flow { while (true) emit(receive()) }

    /** Returns the number of dropped frames since the last call. */
    public fun missed(): Long = taker.missed()

    /** Takes no more frames. */
    override fun close(): Unit = taker.leave()
}

/** A frame of a stream, read as a message. */
public class StreamItem<T : Any> internal constructor(
    /** Message id of the request that the frame belongs to. */
    public val id: Long,
    /** The content of the frame. */
    public val content: T,
)
