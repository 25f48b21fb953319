package fc.runtime

import kotlinx.coroutines.flow.Flow
import kotlinx.coroutines.flow.MutableStateFlow
import kotlinx.coroutines.flow.first
import kotlinx.coroutines.flow.transformWhile

/** Whether there is a connection at this moment, and why not. */
public sealed class ConnectionState {
    /**
     * How many connections have been made, the present one included. A robot may have restarted in between: an app that sees
     * another number than before asks for the robot's state again.
     */
    public abstract val connects: Long

    /** Why there is no connection; `null` while there is one. */
    public abstract val why: Loss?

    /** There is a connection. */
    public class Connected internal constructor(override val connects: Long) : ConnectionState() {
        override val why: Loss? get() = null
    }

    /** There is none, and one is being made: the first, or another one after a loss. What can wait for it does. */
    public class Connecting internal constructor(override val connects: Long, override val why: Loss) : ConnectionState()

    /** There will be none any more. */
    public class Closed internal constructor(override val connects: Long, override val why: Loss) : ConnectionState()

    /** Whether there is a connection. */
    public val isConnected: Boolean get() = this is Connected

    /** Whether there will be none any more. */
    public val isClosed: Boolean get() = this is Closed

    override fun equals(other: Any?): Boolean =
        other is ConnectionState && other.javaClass == javaClass && other.connects == connects && other.why == why

    override fun hashCode(): Int = connects.hashCode()

    override fun toString(): String = "${javaClass.simpleName}($connects${why?.let { ", $it" } ?: ""})"
}

/** The state of a connection, and all who watch it. It is changed on one loop, and seen from anywhere. */
internal class Life(private val onTurn: (ConnectionState) -> Unit = {}) {
    private val told = MutableStateFlow<ConnectionState>(ConnectionState.Connecting(0, Loss.NOT_YET))

    val now: ConnectionState get() = told.value

    /** The state, and each that it comes to; nothing after the last. Who asks late gets the latest. */
    val states: Flow<ConnectionState> = told.transformWhile { state ->
        emit(state)
        !state.isClosed
    }

    fun connected() = turn(ConnectionState.Connected(now.connects + 1))

    fun lost(why: Loss) = turn(ConnectionState.Connecting(now.connects, why))

    /** There will be none. The first reason counts. */
    fun close(why: Loss) = turn(ConnectionState.Closed(now.connects, why))

    private fun turn(state: ConnectionState) {
        if (now.isClosed) return
        onTurn(state)
        told.value = state
    }

    /** Waits until there will be no connection any more, and says why. */
    suspend fun closed(): Loss = checkNotNull(told.first { it.isClosed }.why)

    /** Waits until there is a connection, or will be none any more. */
    suspend fun settled(): ConnectionState = told.first { it.isConnected || it.isClosed }
}
