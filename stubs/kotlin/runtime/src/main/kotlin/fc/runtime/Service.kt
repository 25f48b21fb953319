package fc.runtime

import java.net.SocketAddress
import java.util.concurrent.CompletionStage
import java.util.function.BiFunction
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.future.await

/** What a handler is told beside the request. */
public class Context internal constructor(
    /** Address of the app; `null` of a connection that has none. */
    public val peer: SocketAddress?,
    /** Connection of the app, as the audience of a report. */
    public val connection: Long,
    /** Message id of the request. */
    public val id: Long,
    /** Command code of the request. */
    public val code: Int,
    /** When the request was made, in milliseconds since 1970-01-01T00:00:00Z, if it says so. */
    public val timeMs: Long?,
    private val notImplemented: () -> Refusal,
    private val unknown: Refusal,
    private val failed: (Throwable, Any) -> Unit,
) {
    internal val gone = CompletableDeferred<Unit>()

    /**
     * Whether nobody waits for the answer any more: the connection has ended, or the handler timeout is over and the app has
     * been told so. The handler of a command that sets something in motion runs on then.
     */
    public val isAbandoned: Boolean get() = gone.isCompleted

    /** Returns once [isAbandoned]. */
    @JvmSynthetic
    public suspend fun abandoned(): Unit = gone.await()

    /** Runs [action] once [isAbandoned]. For Java. An exception of it is logged. */
    public fun onAbandoned(action: Runnable) {
        gone.invokeOnCompletion {
            try {
                action.run()
            } catch (failure: Throwable) {
                failed(failure, action)
            }
        }
    }

    /** The refusal of a command that the spec has and this robot does not carry out: nothing has been done. */
    public fun notImplemented(): Refusal = notImplemented.invoke()

    /** The refusal of a command that there is not. */
    public fun unknown(): Refusal = unknown
}

/** Carries out one command: gives the response, or throws a [Refusal]. */
public fun interface Handler<Q : Message, A : Message> {
    /** Carries it out. */
    public suspend fun handle(context: Context, request: Q): A
}

/** A request as received, but known to be a JSON object. */
public class RawRequest internal constructor(
    /** Command code. */
    public val code: Int,
    /** The whole JSON text, envelope included. */
    public val json: Json,
) {
    override fun toString(): String = "RawRequest(code=$code, ${json.text.length} characters)"
}

/**
 * Carries out commands that have no type: gives a JSON object of the response's own keys, or throws a [Refusal]. A key of the
 * envelope in it is sent as it is; the envelope of success supplies those that it lacks.
 */
public fun interface RawHandler {
    /** Carries it out. */
    public suspend fun handle(context: Context, request: RawRequest): Json
}

/**
 * What serves requests: a handler for each command. What has none is refused: as not implemented if the spec has it, as unknown
 * if not.
 */
public class Service {
    /** A command and its handler. The log names the class of [called], the object of the user, if no line is known. */
    internal class Entry<Q : Message, A : Message>(val command: Command<Q, A>, val handler: Handler<Q, A>, val called: Any)

    /** A handler of commands without a type. */
    internal class RawEntry(val handler: RawHandler, val called: Any)

    internal val entries = HashMap<Int, Entry<*, *>>()
    private val ranges = ArrayList<Pair<IntRange, RawEntry>>()
    private var unknown: RawEntry? = null

    internal fun rawHandler(code: Int, isKnown: Boolean): RawEntry? =
        ranges.firstOrNull { code in it.first }?.second ?: unknown.takeIf { !isKnown }

    /** Has [handler] carry out what comes with a code from [first] to [last] that has no handler of its own. */
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

    /** Has [handler] carry out what comes with a code that the spec does not have. */
    @JvmSynthetic
    public fun onUnknown(handler: RawHandler): Service = apply { unknown = RawEntry(handler, handler) }

    /** Has [handler] carry out a command. */
    @JvmSynthetic
    public fun <Q : Message, A : Message> on(command: Command<Q, A>, handler: Handler<Q, A>): Service = apply {
        entries[command.code] = Entry(command, handler, handler)
    }

    /** [on] for Java: the stage fails with a [Refusal] where the command is refused. */
    public fun <Q : Message, A : Message> onAsync(
        command: Command<Q, A>,
        handler: BiFunction<Context, Q, CompletionStage<A>>,
    ): Service = apply {
        entries[command.code] = Entry(command, { context, request -> handler.apply(context, request).await() }, handler)
    }
}
