package fc.runtime

import java.net.SocketAddress
import java.util.concurrent.CompletionStage
import java.util.function.BiFunction
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.future.await

/** The context of a request, for its handler. */
public class Context internal constructor(
    /** Address of the app; `null` for a connection without an address. */
    public val peer: SocketAddress?,
    /** Connection of the app, for [Audience.one]. */
    public val connection: Long,
    /** Message id of the request. */
    public val id: Long,
    /** Command code of the request. */
    public val code: Int,
    /** Creation time of the request, in milliseconds since 1970-01-01T00:00:00Z; `null` if the envelope has none. */
    public val timeMs: Long?,
    private val notImplemented: () -> Refusal,
    private val unknown: Refusal,
    private val failed: (Throwable, Any) -> Unit,
) {
    internal val gone = CompletableDeferred<Unit>()

    /**
     * `true` once the app has stopped waiting: the connection has ended, or the handler timeout has passed and the app
     * knows. The handler of a command that moves the robot continues then.
     */
    public val isAbandoned: Boolean get() = gone.isCompleted

    /** Returns once [isAbandoned]. */
    @JvmSynthetic
    public suspend fun abandoned(): Unit = gone.await()

    /** Runs [action] once [isAbandoned]. For Java. Its exceptions are logged. */
    public fun onAbandoned(action: Runnable) {
        gone.invokeOnCompletion {
            try {
                action.run()
            } catch (failure: Throwable) {
                failed(failure, action)
            }
        }
    }

    /** The refusal of a command that the spec defines and this robot does not implement. */
    public fun notImplemented(): Refusal = notImplemented.invoke()

    /** The refusal of a command that does not exist. */
    public fun unknown(): Refusal = unknown
}

/** Handles one command: returns the response, or throws a [Refusal]. */
public fun interface Handler<Q : Message, A : Message> {
    /** Handles a request. */
    public suspend fun handle(context: Context, request: Q): A
}

/** An untyped request, which is a JSON object. */
public class RawRequest internal constructor(
    /** Command code. */
    public val code: Int,
    /** The complete JSON text, including the envelope. */
    public val json: Json,
) {
    override fun toString(): String = "RawRequest(code=$code, ${json.text.length} characters)"
}

/**
 * Handles untyped commands: returns a JSON object with the keys of the response, or throws a [Refusal]. Envelope keys
 * in it are sent unchanged; the missing ones are those of success.
 */
public fun interface RawHandler {
    /** Handles a request. */
    public suspend fun handle(context: Context, request: RawRequest): Json
}

/**
 * Serves requests with a handler per command. A command without a handler is refused: as not implemented if the spec
 * defines it, otherwise as unknown.
 */
public class Service {
    /** A command and its handler. If no line is known, the log names the class of [called], the object of the user. */
    internal class Entry<Q : Message, A : Message>(val command: Command<Q, A>, val handler: Handler<Q, A>, val called: Any)

    /** A handler of untyped commands. */
    internal class RawEntry(val handler: RawHandler, val called: Any)

    internal val entries = HashMap<Int, Entry<*, *>>()
    private val ranges = ArrayList<Pair<IntRange, RawEntry>>()
    private var unknown: RawEntry? = null

    internal fun rawHandler(code: Int, isKnown: Boolean): RawEntry? =
        ranges.firstOrNull { code in it.first }?.second ?: unknown.takeIf { !isKnown }

    /** Sets the handler of codes from [first] to [last] without another handler. */
    @JvmSynthetic
    public fun onRange(first: Int, last: Int, handler: RawHandler): Service = range(first, last, RawEntry(handler, handler))

    private fun range(first: Int, last: Int, entry: RawEntry): Service = apply {
        Settings.integer("first", first, 0)
        Settings.integer("last", last, first)
        ranges.add(first..last to entry)
    }

    /** [onRange] for Java. */
    public fun onRangeAsync(
        first: Int,
        last: Int,
        handler: BiFunction<Context, RawRequest, CompletionStage<Json>>,
    ): Service = range(first, last, RawEntry({ context, request -> handler.apply(context, request).await() }, handler))

    /** Sets the handler of codes that the spec does not define. */
    @JvmSynthetic
    public fun onUnknown(handler: RawHandler): Service = apply { unknown = RawEntry(handler, handler) }

    /** [onUnknown] for Java. */
    public fun onUnknownAsync(handler: BiFunction<Context, RawRequest, CompletionStage<Json>>): Service = apply {
        unknown = RawEntry({ context, request -> handler.apply(context, request).await() }, handler)
    }

    /** Sets the handler of a command. */
    @JvmSynthetic
    public fun <Q : Message, A : Message> on(command: Command<Q, A>, handler: Handler<Q, A>): Service = apply {
        entries[command.code] = Entry(command, handler, handler)
    }

    /** [on] for Java. To refuse the command, fail the stage with a [Refusal]. */
    public fun <Q : Message, A : Message> onAsync(
        command: Command<Q, A>,
        handler: BiFunction<Context, Q, CompletionStage<A>>,
    ): Service = apply {
        entries[command.code] = Entry(command, { context, request -> handler.apply(context, request).await() }, handler)
    }
}
