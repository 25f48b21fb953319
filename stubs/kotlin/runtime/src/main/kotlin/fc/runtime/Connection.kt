package fc.runtime

import java.util.concurrent.CompletableFuture
import java.util.concurrent.TimeUnit
import java.util.function.Consumer
import kotlin.coroutines.resume
import kotlin.coroutines.resumeWithException
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.flow.Flow
import kotlinx.coroutines.future.future
import kotlinx.coroutines.launch
import kotlinx.coroutines.suspendCancellableCoroutine

/** What one call can be told; each method gives a changed copy. */
public class CallOptions private constructor(internal val timeout: Long?, internal val repeat: Boolean?) {
    /** As the connection is told. */
    public constructor() : this(null, null)

    /** How long to wait for the response. */
    public fun timeout(timeout: Long, unit: TimeUnit): CallOptions =
        CallOptions(Settings.duration("CallOptions.timeout", timeout, unit), repeat)

    /**
     * Whether to send the call once more when the connection was lost before its answer came. Unless set, only what
     * [only reads][Effect.READ]. `true` on anything else may do it twice.
     */
    public fun repeat(repeat: Boolean): CallOptions = CallOptions(timeout, repeat)

    internal companion object {
        val DEFAULT = CallOptions()
    }
}

/** Why a connection could not be made. */
public class ConnectError internal constructor(
    /** Host and port. */
    public val address: String,
    /** What the network said, or that it was too late. */
    public val loss: Loss,
) : Exception("cannot connect to $address: $loss", loss.cause)

/** A response as received, whose result nobody has judged. */
public class RawResponse internal constructor(
    /** Its result code; `null` if no response carries one. */
    public val resultCode: Long?,
    /** The whole JSON text, envelope included. */
    public val json: String,
) {
    override fun toString(): String = "RawResponse(result $resultCode, ${json.length} characters)"
}

/**
 * A connection to a robot. It is made again after a loss, as its configuration says, and is open until it is [closed][close].
 * Any thread may use it.
 */
public class Connection internal constructor(internal val core: ClientCore, private val dataDial: Dial) : AutoCloseable {
    private val protocol = core.protocol

    /**
     * Calls a command and waits for its response. A coroutine that is cancelled gives its place in flight back; the robot
     * acts all the same once the request is on its way.
     *
     * @throws CallError if there is no such response in time
     */
    @JvmSynthetic
    public suspend fun <Q : Message, A : Message> call(
        command: Command<Q, A>,
        request: Q,
        options: CallOptions = CallOptions(),
    ): A {
        val body = prepared(command, request)
        return response(command, sent(command.code, command.effect == Effect.READ, options, body))
    }

    /** [call] for Java. Cancelling the future gives the call up; it fails with a [CallError]. */
    @JvmOverloads
    public fun <Q : Message, A : Message> callAsync(
        command: Command<Q, A>,
        request: Q,
        options: CallOptions = CallOptions(),
    ): CompletableFuture<A> = SCOPE.future { call(command, request, options) }

    /**
     * Calls a code with a JSON object of the request's own keys. The envelope is added. It is not sent again after a loss,
     * unless the options say so. The result is not judged: a refusal is a response, too.
     *
     * @throws CallError of any kind but refused
     */
    @JvmSynthetic
    public suspend fun callRaw(code: Int, json: String, options: CallOptions = CallOptions()): RawResponse {
        protocol.header.checkCode(code)
        val body = encoded {
            val keys = Bodies.decode(Keys, json.toByteArray(), core.limits.json())
            Bodies.write(Envelopes.request(protocol, System.currentTimeMillis()), keys)
        }
        val answer = sent(code, false, options, body)
        try {
            val read = Bodies.enveloped(protocol.responseEnvelope, Empty, answer, core.limits.json())
            return RawResponse(Envelopes.resultCode(protocol, read.envelope), Bodies.utf8(answer))
        } catch (error: BodyError) {
            throw CallError(CallErrorKind.INVALID_RESPONSE, cause = error)
        }
    }

    /** [callRaw] for Java. */
    @JvmOverloads
    public fun callRawAsync(code: Int, json: String, options: CallOptions = CallOptions()): CompletableFuture<RawResponse> =
        SCOPE.future { callRaw(code, json, options) }

    /**
     * Calls a command, waits for its response, and then follows what it has set off: the reports of one kind that
     * [belongs] says yes to, until one of them says that the process has ended or failed. What arrives from the moment on in
     * which the request is sent is followed, also before the response. [Close][Following.close] what is not followed to its
     * end.
     *
     * @throws CallError those of the call; nothing is followed then
     */
    @JvmSynthetic
    public suspend fun <Q : Message, A : Message, R : Message> follow(
        command: Command<Q, A>,
        request: Q,
        report: Report<R>,
        options: CallOptions = CallOptions(),
        belongs: (Q, A, R) -> Boolean = { _, _, _ -> true },
    ): Following<A, R> {
        val receiver = core.queues.enter(report.code)
        val answer = try {
            call(command, request, options)
        } catch (failure: Throwable) {
            receiver.leave()
            throw failure
        }
        return Following(core, receiver, report, answer) { belongs(request, answer, it) }
    }

    /**
     * The robot's reports from here on. Each receiver gets all of them, and has a queue of its own; close it when it is not
     * needed any more. Reports are acknowledged only when a receiver has them: without one, the robot sends each again until
     * it gives up.
     */
    public fun reports(): Reports = Reports(core.queues.enter(null))

    /**
     * Calls [listener] with each report from here on, one at a time, until the result is closed. For Java. An exception of the
     * listener is logged, and the next report reaches it all the same.
     */
    public fun onReport(listener: Consumer<ReceivedReport>): AutoCloseable {
        val reports = reports()
        SCOPE.launch { while (true) told("the listener of reports", listener, reports.receive() ?: break) }
        return reports
    }

    private fun <T> told(what: String, listener: Consumer<T>, news: T) = try {
        listener.accept(news)
    } catch (failure: Throwable) {
        core.listenerFailed(what, failure, listener)
    }

    /**
     * A connection to the robot's data port, of this command connection and as long as it. Returns at once; the connection is
     * made in the background. Each call makes another one.
     */
    public fun data(): DataConnection = DataConnection(DataCore(core, dataDial).also { it.begin() })

    /** Whether there is a connection at this moment, and why not. */
    public val state: ConnectionState get() = core.life.now

    /**
     * The states of the connection: the present one first, then each that it comes to, and nothing after the last. Nothing is
     * queued: who asks late gets the latest.
     */
    public fun states(): Flow<ConnectionState> = core.life.states

    /**
     * Calls [listener] with the state and each that it comes to, until the result is closed. For Java. An exception of the
     * listener is logged, and the next state reaches it all the same.
     */
    public fun onState(listener: Consumer<ConnectionState>): AutoCloseable {
        val watch = SCOPE.launch { states().collect { told("the listener of states", listener, it) } }
        return AutoCloseable { watch.cancel() }
    }

    /** Waits until the connection has ended for good, and says why. */
    @JvmSynthetic
    public suspend fun closed(): Loss = core.life.closed()

    /** How many calls are in flight. */
    public val inFlight: Int get() = core.inFlight

    /** What the connection has seen so far. */
    public val counters: ClientCounters get() = ClientCounters(core.counting.read())

    /** Closes the connection. Calls in flight end as lost, and reports once their queue is empty. */
    override fun close(): Unit = core.loop.execute { core.close() }

    private fun <Q : Message> prepared(command: Command<Q, *>, request: Q): Prepared = encoded {
        command.request.demand(request)
        Bodies.write(Envelopes.request(protocol, System.currentTimeMillis()), request)
    }

    private inline fun encoded(write: () -> ByteArray): Prepared = try {
        core.encoder.prepare(write())
    } catch (error: BodyError) {
        throw CallError(CallErrorKind.INVALID_REQUEST, cause = error)
    } catch (error: FrameError) {
        throw CallError(CallErrorKind.FRAME, cause = error)
    }

    private suspend fun sent(code: Int, repeats: Boolean, options: CallOptions, body: Prepared): ByteArray =
        suspendCancellableCoroutine { waiting ->
            val timeout = options.timeout ?: core.config.callTimeout ?: protocol.defaults.callTimeout
            val call = CallInFlight(code, timeout, options.repeat ?: repeats, body) { answer, error ->
                if (answer != null) waiting.resume(answer) else waiting.resumeWithException(checkNotNull(error))
            }
            waiting.invokeOnCancellation { core.loop.execute { core.cancel(call) } }
            core.loop.execute(waiting) { if (waiting.isActive) core.start(call) }
        }

    private fun <A : Message> response(command: Command<*, A>, body: ByteArray): A {
        val read = try {
            Bodies.enveloped(protocol.responseEnvelope, command.response, body, core.limits.json())
        } catch (error: BodyError) {
            throw CallError(CallErrorKind.INVALID_RESPONSE, cause = error)
        }
        Envelopes.refusal(protocol, read.envelope)?.let {
            throw CallError(CallErrorKind.REFUSED, cause = it, declared = command.declared)
        }
        return read.body ?: throw CallError(CallErrorKind.INVALID_RESPONSE, cause = read.fault)
    }

    public companion object {
        /** Where what Java has asked for goes on. */
        private val SCOPE = CoroutineScope(SupervisorJob() + Dispatchers.Default)

        /**
         * Connects over TCP.
         *
         * @throws ConnectError if the first attempt fails; later losses are handled in the background
         */
        @JvmSynthetic
        public suspend fun connect(protocol: Protocol, config: ClientConfig = ClientConfig()): Connection {
            val connection = tcp(protocol, config, isFirstOnly = true)
            try {
                val state = connection.core.life.settled()
                if (state is ConnectionState.Closed) throw ConnectError(address(protocol, config), state.why)
            } catch (failure: Throwable) {
                connection.close()
                throw failure
            }
            return connection
        }

        /** [connect] for Java. */
        @JvmStatic
        @JvmOverloads
        public fun connectAsync(protocol: Protocol, config: ClientConfig = ClientConfig()): CompletableFuture<Connection> =
            SCOPE.future { connect(protocol, config) }

        /**
         * Connects over TCP in the background, and returns at once: the first connection is waited for like another one after
         * a loss. Calls made meanwhile wait within their timeout.
         */
        @JvmStatic
        @JvmOverloads
        public fun connectLazy(protocol: Protocol, config: ClientConfig = ClientConfig()): Connection =
            tcp(protocol, config, isFirstOnly = false)

        private fun address(protocol: Protocol, config: ClientConfig) =
            "${config.host ?: protocol.host}:${config.commandPort ?: protocol.commandPort}"

        private fun tcp(protocol: Protocol, config: ClientConfig, isFirstOnly: Boolean): Connection {
            val loop = NioLoop("fc-client", config.log)
            val host = config.host ?: protocol.host
            fun dial(port: Int) = Dial { done -> loop.connect(host, port, config.keepalive, done) }
            val core = ClientCore(protocol, config, loop, dial(config.commandPort ?: protocol.commandPort))
            core.onEnd = { loop.schedule(after(loop.now, FAREWELL)) { loop.end() } }
            core.begin(isFirstOnly)
            return Connection(core, dial(config.dataPort ?: protocol.dataPort))
        }

        /** Data connections say goodbye a moment after the command connection. */
        private const val FAREWELL = 2000L
    }
}

/** A message all of whose keys are kept as they are. */
internal class Keys private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<Keys> get() = Keys

    companion object : MessageType<Keys>("Keys") {
        override fun create(content: Content): Keys = Keys(content)
    }
}
