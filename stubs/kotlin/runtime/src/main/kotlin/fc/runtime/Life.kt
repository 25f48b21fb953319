package fc.runtime

import kotlinx.coroutines.flow.Flow
import kotlinx.coroutines.flow.MutableStateFlow
import kotlinx.coroutines.flow.first
import kotlinx.coroutines.flow.transformWhile

/** The state of a connection: connected, connecting or closed, with the reason while it is down. */
public sealed class ConnectionState {
    /**
     * Number of connections made so far, including the current one. If it changes, the robot may have restarted: query
     * its state again.
     */
    public abstract val connects: Long

    /** The reason why the connection is down; `null` while it is up. */
    public abstract val why: Loss?

    /** The connection is up. */
    public class Connected internal constructor(override val connects: Long) : ConnectionState() {
        override val why: Loss? get() = null
    }

    /** The client is connecting, for the first time or after a loss. Operations that can wait do so. */
    public class Connecting internal constructor(override val connects: Long, override val why: Loss) : ConnectionState()

    /** The connection is closed for good. */
    public class Closed internal constructor(override val connects: Long, override val why: Loss) : ConnectionState()

    /** `true` while the connection is up. */
    public val isConnected: Boolean get() = this is Connected

    /** `true` once the connection is closed for good. */
    public val isClosed: Boolean get() = this is Closed

    override fun equals(other: Any?): Boolean =
        other is ConnectionState && other.javaClass == javaClass && other.connects == connects && other.why == why

    override fun hashCode(): Int = connects.hashCode()

    override fun toString(): String = "${javaClass.simpleName}($connects${why?.let { ", $it" } ?: ""})"
}

/** The state of a connection, and its watchers. One loop changes it, and any thread reads it. */
internal class Life(private val onTurn: (ConnectionState) -> Unit = {}) {
    private val told = MutableStateFlow<ConnectionState>(ConnectionState.Connecting(0, Loss.NOT_YET))

    val now: ConnectionState get() = told.value

    /** The states, from the current one to the last. A late collector gets only the latest. */
    val states: Flow<ConnectionState> = told.transformWhile { state ->
        emit(state)
        !state.isClosed
    }

    fun connected() = turn(ConnectionState.Connected(now.connects + 1))

    fun lost(why: Loss) = turn(ConnectionState.Connecting(now.connects, why))

    /** Closes the connection for good. The first reason counts. */
    fun close(why: Loss) = turn(ConnectionState.Closed(now.connects, why))

    private fun turn(state: ConnectionState) {
        if (now.isClosed) return
        onTurn(state)
        told.value = state
    }

    /** Waits until the connection is closed for good, and returns the reason. */
    suspend fun closed(): Loss = checkNotNull(told.first { it.isClosed }.why)

    /** Waits until the connection is up or closed for good. */
    suspend fun settled(): ConnectionState = told.first { it.isConnected || it.isClosed }
}
