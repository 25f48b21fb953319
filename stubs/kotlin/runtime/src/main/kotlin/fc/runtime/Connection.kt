package fc.runtime

import java.util.concurrent.CancellationException
import java.util.concurrent.CompletableFuture
import java.util.concurrent.TimeUnit
import java.util.function.Consumer
import kotlin.coroutines.resume
import kotlin.coroutines.resumeWithException
import kotlinx.coroutines.flow.Flow
import kotlinx.coroutines.suspendCancellableCoroutine

/** The options of one call. Each method returns a changed copy. */
public class CallOptions private constructor(internal val timeout: Long?, internal val repeat: Boolean?) {
    /** The defaults of the connection. */
    public constructor() : this(null, null)

    /** Longest wait for the response. */
    public fun timeout(timeout: Long, unit: TimeUnit): CallOptions =
        CallOptions(Settings.duration("CallOptions.timeout", timeout, unit), repeat)

    /**
     * Sends the call once more if the connection is lost before its response arrives. Unset: only calls with
     * [Effect.READ] are repeated. With `true`, the robot may execute any other call twice.
     */
    public fun repeat(repeat: Boolean): CallOptions = CallOptions(timeout, repeat)

    internal companion object {
        val DEFAULT = CallOptions()
    }
}

/** The error of a failed connection attempt. */
public class ConnectError internal constructor(
    /** Host and port. */
    public val address: String,
    /** The error of the network, or the timeout. */
    public val loss: Loss,
) : Exception("cannot connect to $address: $loss", loss.cause)

/** An unchecked response, which may be a refusal. */
public class RawResponse internal constructor(
    /** The result code; `null` if responses carry none. */
    public val resultCode: Long?,
    /** The complete JSON text, including the envelope. */
    public val json: String,
) {
    override fun toString(): String = "RawResponse(result $resultCode, ${json.length} characters)"
}

/**
 * A connection to a robot. It reconnects after a loss according to its configuration, and stays open until [close]. Any
 * thread may use it.
 */
public class Connection internal constructor(internal val core: ClientCore, private val dataDial: Dial) : AutoCloseable {
    private val protocol = core.protocol

    /**
     * Calls a command and waits for its response. Cancelling the coroutine frees the slot of the call. A request that
     * was sent still takes effect on the robot.
     *
     * @throws CallError if the call fails
     */
    @JvmSynthetic
    public suspend fun <Q : Message, A : Message> call(
        command: Command<Q, A>,
        request: Q,
        options: CallOptions = CallOptions(),
    ): A {
        return told(command.code) {
            val body = prepared(command, request)
            response(command, sent(command.code, command.effect == Effect.READ, options, body))
        }
    }

    /** [call] for Java. Cancelling the future cancels the call. The future fails with a [CallError]. */
    @JvmOverloads
    public fun <Q : Message, A : Message> callAsync(
        command: Command<Q, A>,
        request: Q,
        options: CallOptions = CallOptions(),
    ): CompletableFuture<A> = Futures.of { call(command, request, options) }

    /**
     * Calls a code with a JSON object without envelope keys. The envelope is added. The call is repeated after a loss
     * only if the options request it. The result is not checked: a refusal is a response, too.
     *
     * @throws CallError of any kind except [CallErrorKind.REFUSED]
     */
    @JvmSynthetic
    public suspend fun callRaw(code: Int, json: String, options: CallOptions = CallOptions()): RawResponse {
        protocol.header.checkCode(code)
        return told(code) {
            val body = encoded {
                val keys = Bodies.decode(Keys, json.toByteArray(), core.limits.json())
                Bodies.write(Envelopes.request(protocol, System.currentTimeMillis()), keys)
            }
            val answer = sent(code, false, options, body)
            try {
                val read = Bodies.enveloped(protocol.responseEnvelope, Empty, answer, core.limits.json())
                RawResponse(Envelopes.resultCode(protocol, read.envelope), Bodies.utf8(answer))
            } catch (error: BodyError) {
                throw CallError(CallErrorKind.INVALID_RESPONSE, cause = error)
            }
        }
    }

    /** Makes a call, and tells the hook its end. */
    private inline fun <T> told(code: Int, call: () -> T): T {
        val hook = core.config.onCall ?: return call()
        val since = System.nanoTime()
        var result: String? = null
        try {
            return call().also { result = "success" }
        } catch (error: CallError) {
            result = error.name
            throw error
        } catch (error: CancellationException) {
            result = "dropped"
            throw error
        } finally {
            result?.let { core.told("`onCall`", hook, EndedCall.of(protocol, code, it, since)) }
        }
    }

    /** [callRaw] for Java. */
    @JvmOverloads
    public fun callRawAsync(code: Int, json: String, options: CallOptions = CallOptions()): CompletableFuture<RawResponse> =
        Futures.of { callRaw(code, json, options) }

    /**
     * Calls a command, waits for its response, and then follows its process. The events are the reports of one kind for
     * which [belongs] returns `true`, until a report ends the process or means a failure. They start when the request
     * is sent, and may precede the response. [Close][Following.close] the result if you stop before the end.
     *
     * @throws CallError if the call fails; then nothing is followed
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

    /** Makes a future of a suspending call of this connection. The generated methods for Java use it. */
    @JvmSynthetic
    public fun <T> future(call: suspend () -> T): CompletableFuture<T> = Futures.of(call)

    /**
     * Returns the reports from now on. Each receiver has its own queue and gets all reports. Close it after use.
     * Reports are acknowledged only if a receiver has them. Without one, the robot repeats each until it gives up.
     */
    public fun reports(): Reports = Reports(core.queues.enter(null))

    /**
     * Calls [listener] with each report from now on, one at a time, until the result is closed. For Java. An exception
     * of the listener is logged, and the next report still reaches it.
     */
    public fun onReport(listener: Consumer<ReceivedReport>): AutoCloseable {
        val reports = reports()
        Futures.launch { while (true) core.told("the listener of reports", listener, reports.receive() ?: break) }
        return reports
    }

    /**
     * Opens a connection to the data port. It follows this command connection. Returns at once and connects in the
     * background. Each call opens another one.
     */
    public fun data(): DataConnection = DataConnection(DataCore(core, dataDial).also { it.begin() })

    /** The current state of the connection. */
    public val state: ConnectionState get() = core.life.now

    /**
     * The states of the connection, from the current one to the last. States are not queued: a late collector gets only
     * the latest.
     */
    public fun states(): Flow<ConnectionState> = core.life.states

    /**
     * Calls [listener] with the current state and each later one, until the result is closed. For Java. An exception of
     * the listener is logged, and the next state still reaches it.
     */
    public fun onState(listener: Consumer<ConnectionState>): AutoCloseable = core.watch(core.life, listener)

    /** Waits until the connection has ended for good, and returns the reason. */
    @JvmSynthetic
    public suspend fun closed(): Loss = core.life.closed()

    /** [closed] for Java. */
    public fun closedAsync(): CompletableFuture<Loss> = Futures.of { closed() }

    /** Number of calls in flight. */
    public val inFlight: Int get() = core.inFlight

    /** The counters of the connection. */
    public val counters: ClientCounters get() = ClientCounters(core.counting.read())

    /** Closes the connection. Calls in flight end as lost. Reports end after the queue is empty. */
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
            Futures.of { connect(protocol, config) }

        /**
         * Returns at once and connects over TCP in the background. A failed first attempt is repeated like one after a
         * loss. Calls made in the meantime wait within their timeout.
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
            fun dial(port: Int): Dial {
                val dial = Dial { done -> loop.connect(host, port, config.keepalive, done) }
                val tls = config.tls ?: return dial
                return TlsDial(loop, dial) { tls.client(host, port) }
            }
            val core = ClientCore(protocol, config, loop, dial(config.commandPort ?: protocol.commandPort))
            core.onEnd = { loop.schedule(after(loop.now, FAREWELL)) { loop.end() } }
            core.begin(isFirstOnly)
            return Connection(core, dial(config.dataPort ?: protocol.dataPort))
        }

        /** Data connections close a moment after the command connection. */
        private const val FAREWELL = 2000L
    }
}

/** A message that keeps all of its keys unchanged. */
internal class Keys private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<Keys> get() = Keys

    companion object : MessageType<Keys>("Keys") {
        override fun create(content: Content): Keys = Keys(content)
    }
}
