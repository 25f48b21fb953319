package fc.runtime

import java.util.concurrent.CompletableFuture
import java.util.function.Consumer
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.Job
import kotlinx.coroutines.SupervisorJob
import kotlinx.coroutines.future.future
import kotlinx.coroutines.launch

/** Runs suspending calls for Java. */
internal object Futures {
    private val SCOPE = CoroutineScope(SupervisorJob() + Dispatchers.Default)

    /** Cancelling the future cancels the call. */
    fun <T> of(call: suspend () -> T): CompletableFuture<T> = SCOPE.future { call() }

    /** A future without a value. */
    fun done(call: suspend () -> Unit): CompletableFuture<Void?> = SCOPE.future {
        call()
        null
    }

    fun launch(call: suspend () -> Unit): Job = SCOPE.launch { call() }
}

/** Gives [news] to a listener. Its exception goes to the log. */
internal fun <T> ClientCore.told(what: String, listener: Consumer<T>, news: T) = try {
    listener.accept(news)
} catch (failure: Throwable) {
    listenerFailed(what, failure, listener)
}

/** Calls [listener] with the states of [life], until the result is closed. */
internal fun ClientCore.watch(life: Life, listener: Consumer<ConnectionState>): AutoCloseable {
    val watch = Futures.launch { life.states.collect { told("the listener of states", listener, it) } }
    return AutoCloseable { watch.cancel() }
}
