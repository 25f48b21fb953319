package fc.runtime

/** A connection of a robot, as its [MemoryBudget] sees it. */
internal interface MemoryHolder {
    /** Bytes that the connection holds. */
    val held: Long

    /** Bytes that closing the connection gives back: [held], and its stream frames that wait for the robot. */
    val weight: Long get() = held

    /** The part of [held] that the budget has counted. */
    var counted: Long

    /** Gives back buffers that nothing is in. */
    fun tidy()

    /** Looks again: there may be room now. */
    fun wake()
}

/**
 * The bytes that apps make a robot hold, at both ports together. On the loop alone, except [total].
 *
 * A connection asks for room before it grows. If there is none, the connection that holds most is closed. Closing a connection
 * does not give back its requests in handlers. They may take half of all, and further requests wait.
 */
internal class MemoryBudget(
    private val limit: Long,
    private val holders: () -> List<MemoryHolder>,
    /** Bytes of stream frames that wait for the robot, of all connections. */
    private val inbox: () -> Long,
    private val evict: (MemoryHolder) -> Unit,
) {
    @Volatile
    private var held = 0L

    @Volatile
    private var lent = 0L
    private val waiting = LinkedHashSet<MemoryHolder>()

    /** Bytes held at this moment. From any thread. */
    val total: Long get() = held + lent + inbox()

    /** Counts the bytes that a connection holds now. If they are too many, connections go. */
    fun settle(holder: MemoryHolder) {
        val now = holder.held
        val before = holder.counted
        if (now == before) return
        holder.counted = now
        held += now - before
        if (now < before) gaveBack() else if (!hasRoom(0)) makeRoom(0, null)
    }

    /** Forgets a connection that has ended. */
    fun leave(holder: MemoryHolder) {
        held -= holder.counted
        holder.counted = 0
        waiting.remove(holder)
        gaveBack()
    }

    /** Makes room for so many bytes. `false` if there is none: [holder] is woken when bytes are given back. */
    fun room(holder: MemoryHolder, bytes: Long): Boolean {
        if (hasRoom(bytes)) return true
        makeRoom(bytes, holder)
        return hasRoom(bytes).also { if (!it) await(holder) }
    }

    /** Returns `true` if so many bytes fit without closing a connection. */
    fun hasRoom(bytes: Long): Boolean = total + bytes <= limit

    /** Wakes a connection when bytes are given back. */
    fun await(holder: MemoryHolder) {
        waiting.add(holder)
    }

    /** Lends so many bytes to a handler. `false` if handlers have too many: [holder] is woken when one gives its own back. */
    fun lend(holder: MemoryHolder, bytes: Long): Boolean {
        if (bytes > SMALL && lent > 0 && lent + bytes > limit / 2) {
            await(holder)
            return false
        }
        lent += bytes
        return true
    }

    /** Takes back the bytes of a handler that has ended. */
    fun giveBack(bytes: Long) {
        lent -= bytes
        gaveBack()
    }

    /** Wakes the connections that wait for bytes. */
    fun gaveBack() {
        if (waiting.isEmpty()) return
        val woken = waiting.toList()
        waiting.clear()
        woken.forEach { it.wake() }
    }

    /** Closes the connections that hold most until so many bytes fit; none if that cannot suffice for the one that [asks]. */
    private fun makeRoom(bytes: Long, asks: MemoryHolder?) {
        for (holder in holders()) {
            holder.tidy()
            held += holder.held - holder.counted
            holder.counted = holder.held
        }
        val most = holders().sumOf { if (it === asks || it.weight < NEEDED) 0L else it.weight }
        if (asks != null && total + bytes - most > limit) return
        while (!hasRoom(bytes)) {
            val greatest = holders().maxByOrNull { it.weight }?.takeIf { it.weight >= NEEDED } ?: return
            evict(greatest)
            // It does not need the bytes any more.
            if (greatest === asks) return
        }
    }

    private companion object {
        /** A connection that holds fewer bytes is not closed: any connection needs as many. */
        const val NEEDED = 128L * 1024

        /** A request of so many bytes or fewer never waits for handlers: a robot that is busy still answers. */
        const val SMALL = 8L * 1024
    }
}
