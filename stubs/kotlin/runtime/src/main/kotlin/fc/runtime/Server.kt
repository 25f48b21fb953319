package fc.runtime

import java.io.IOException
import java.net.InetSocketAddress
import java.net.SocketAddress
import java.nio.channels.ServerSocketChannel
import java.nio.channels.SocketChannel
import java.util.concurrent.CompletableFuture
import java.util.concurrent.TimeUnit
import kotlin.coroutines.resume
import kotlinx.coroutines.CoroutineDispatcher
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.async
import kotlinx.coroutines.awaitAll
import kotlinx.coroutines.cancel
import kotlinx.coroutines.coroutineScope
import kotlinx.coroutines.suspendCancellableCoroutine

/** A robot. It listens on both ports and handles requests with a [Service]. Any thread may use it. */
public class Server internal constructor(
    internal val core: ServerCore,
    private val commands: ServerSocketChannel?,
    private val data: ServerSocketChannel?,
) : AutoCloseable {
    private val protocol = core.protocol

    /** The address of the command port. */
    public val commandAddress: InetSocketAddress get() = checkNotNull(commands).socket().localSocketAddress as InetSocketAddress

    /** The address of the data port. */
    public val dataAddress: InetSocketAddress get() = checkNotNull(data).socket().localSocketAddress as InetSocketAddress

    /**
     * Sends a report to one app, or to all, and waits until it has ended at each. Each app has its own queue, so a slow
     * one does not delay the others.
     *
     * @throws PushError if it was not queued
     */
    @JvmSynthetic
    public suspend fun <R : Message> push(audience: Audience, report: Report<R>, message: R): List<Acknowledgement> {
        val body = prepared {
            report.message.demand(message)
            Bodies.write(Envelopes.request(protocol, System.currentTimeMillis()), message)
        }
        val policy = report.ack ?: protocol.defaults.ack
        return suspendCancellableCoroutine { waiting ->
            core.loop.execute(waiting) {
                val ended = ArrayList<Acknowledgement>()
                var expected = -1
                fun look() {
                    if (ended.size == expected) waiting.resume(ended)
                }
                val count = core.push(audience) { connection ->
                    Queued(report.code, policy, body) { outcome, refusal ->
                        ended.add(Acknowledgement(connection, outcome, refusal))
                        look()
                    }
                }
                expected = count
                if (count >= 0) {
                    look()
                } else {
                    waiting.resumeWith(Result.failure(PushError(PushErrorKind.NO_CONNECTION)))
                }
            }
        }
    }

    /** [push] for Java. */
    public fun <R : Message> pushAsync(
        audience: Audience,
        report: Report<R>,
        message: R,
    ): CompletableFuture<List<Acknowledgement>> = Futures.of { push(audience, report, message) }

    /**
     * Sends a frame of raw bytes to the data connections of one app, or of all. [code] is the stream, [id] the request
     * that the bytes belong to. Each data connection has a short queue. The call waits for space in all of them, at
     * most for the stall timeout. Returns the number of connections that took the frame.
     *
     * In the protocol, only the address relates a data connection to an app. A data connection belongs to a command
     * connection if no other one was open at the same address in the meantime.
     *
     * @throws PushError if there is no connection to send to, or it is ambiguous
     */
    @JvmSynthetic
    public suspend fun sendStream(audience: Audience, code: Int, id: Long, data: ByteArray): Int {
        protocol.header.checkCode(code)
        protocol.header.checkId(id)
        val frame = prepared { data }.frame(FrameId(false, protocol.streamKind, code, id))
        val peers = onLoop { core.dataAudience(audience) }
        return coroutineScope {
            peers.map { peer ->
                async {
                    suspendCancellableCoroutine { waiting ->
                        core.loop.execute(waiting) {
                            peer.offer(frame) { isQueued -> if (waiting.isActive) waiting.resume(isQueued) }
                        }
                    }
                }
            }.awaitAll().count { it }
        }
    }

    /** Sends a frame with a JSON object, without an envelope, like one with raw bytes. */
    @JvmSynthetic
    public suspend fun sendStream(audience: Audience, code: Int, id: Long, content: Message): Int {
        try {
            content.check()
        } catch (error: BodyError) {
            throw PushError(PushErrorKind.INVALID, error)
        }
        return sendStream(audience, code, id, content.toJson().text.toByteArray())
    }

    /** [sendStream] for Java. */
    public fun sendStreamAsync(audience: Audience, code: Int, id: Long, data: ByteArray): CompletableFuture<Int> =
        Futures.of { sendStream(audience, code, id, data) }

    /** [sendStream] for Java. */
    public fun sendStreamAsync(audience: Audience, code: Int, id: Long, content: Message): CompletableFuture<Int> =
        Futures.of { sendStream(audience, code, id, content) }

    /**
     * Returns the frames of raw bytes that apps send from now on. Without a receiver, they are dropped and counted.
     * While the receiver is busy, apps are not read. A later call replaces the receiver.
     */
    public fun streams(): AppStreams = AppStreams(core.inbox, core.inbox.enter())

    /** Returns the connected apps with their connections. */
    @JvmSynthetic
    public suspend fun connections(): Map<Long, SocketAddress?> = onLoop { core.connections() }

    /** Bytes that apps make the robot hold now; see [ServerConfig.memory]. */
    public val memory: Long get() = core.memory.total

    /** The counters of the robot. */
    public val counters: ServerCounters get() = ServerCounters(core.counting.read())

    /**
     * Shuts down gracefully and waits for the end. The robot stops accepting connections and requests, responds to the
     * current requests, and waits for abandoned handlers. After [grace], it closes the rest. Of several calls, the
     * earliest end counts.
     */
    @JvmSynthetic
    public suspend fun shutdown(grace: Long, unit: TimeUnit) {
        val most = Settings.duration("grace", grace, unit)
        stopListening()
        suspendCancellableCoroutine { waiting ->
            core.loop.execute(waiting) { core.stop(most) { if (waiting.isActive) waiting.resume(Unit) } }
        }
        core.scope.cancel()
        (core.loop as? NioLoop)?.end()
    }

    /** [shutdown] for Java. */
    public fun shutdownAsync(grace: Long, unit: TimeUnit): CompletableFuture<Void?> = Futures.done {
        shutdown(grace, unit)
    }

    /** Ends the robot at once. */
    override fun close() {
        stopListening()
        core.loop.execute {
            core.abort()
            core.scope.cancel()
            (core.loop as? NioLoop)?.end()
        }
    }

    private fun stopListening() {
        commands?.close()
        data?.close()
    }

    private inline fun prepared(write: () -> ByteArray): Prepared = try {
        core.encoder.prepare(write())
    } catch (error: BodyError) {
        throw PushError(PushErrorKind.INVALID, error)
    } catch (error: FrameError) {
        throw PushError(PushErrorKind.FRAME, error)
    }

    private suspend fun <T> onLoop(task: () -> T): T = suspendCancellableCoroutine { waiting ->
        core.loop.execute { waiting.resumeWith(runCatching(task)) }
    }

    public companion object {
        /**
         * Listens on both ports and serves from now on.
         *
         * @param dispatcher runs the handlers
         * @throws IOException if a port is not available
         */
        @JvmStatic
        @JvmOverloads
        @Throws(IOException::class)
        public fun bind(
            protocol: Protocol,
            service: Service,
            config: ServerConfig = ServerConfig(),
            dispatcher: CoroutineDispatcher = Dispatchers.Default,
        ): Server {
            val loop = NioLoop("fc-robot", config.log)
            val core = ServerCore(protocol, config, loop, service, CoroutineScope(SupervisorJob() + dispatcher))
            fun link(channel: SocketChannel): Link {
                val link = loop.link(channel, config.keepalive)
                return config.tls?.let { core.secured(link, it.server(), channel.socket().remoteSocketAddress) } ?: link
            }
            var commands: ServerSocketChannel? = null
            try {
                commands = loop.listen(InetSocketAddress(config.address, config.commandPort ?: protocol.commandPort)) { channel ->
                    val link = link(channel)
                    if (!core.serve(link, channel.socket().remoteSocketAddress)) link.close()
                }
                val data = loop.listen(InetSocketAddress(config.address, config.dataPort ?: protocol.dataPort)) { channel ->
                    val link = link(channel)
                    if (!core.serveData(link, channel.socket().remoteSocketAddress)) link.close()
                }
                return Server(core, commands, data)
            } catch (failure: Throwable) {
                commands?.close()
                loop.end()
                throw failure
            }
        }
    }
}
