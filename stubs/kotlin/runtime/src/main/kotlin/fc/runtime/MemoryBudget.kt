package fc.runtime

/** A connection of a robot, from the view of its [MemoryBudget]. */
internal interface MemoryHolder {
    /** Bytes that the connection holds. */
    val held: Long

    /** Bytes that closing the connection frees: [held], and its stream frames that wait for the robot. */
    val weight: Long get() = held

    /** The part of [held] that the budget has counted. */
    var counted: Long

    /** Frees empty buffers. */
    fun tidy()

    /** Tries again: there may be room now. */
    fun wake()
}

/**
 * The bytes that apps make a robot hold, at both ports together. For the loop alone, except [total].
 *
 * A connection asks for room before it grows. Without room, the connection that holds most is closed. Closing a
 * connection does not free its requests in handlers. They may take half of the limit; further requests wait.
 */
internal class MemoryBudget(
    private val limit: Long,
    private val holders: () -> List<MemoryHolder>,
    /** Bytes of stream frames of all connections that wait for the robot. */
    private val inbox: () -> Long,
    private val evict: (MemoryHolder) -> Unit,
) {
    @Volatile
    private var held = 0L

    @Volatile
    private var lent = 0L
    private val waiting = LinkedHashSet<MemoryHolder>()

    /** Bytes held at this moment. For any thread. */
    val total: Long get() = held + lent + inbox()

    /** Counts the bytes that a connection holds now. Above the limit, connections are closed. */
    fun settle(holder: MemoryHolder) {
        val now = holder.held
        val before = holder.counted
        if (now == before) return
        holder.counted = now
        held += now - before
        if (now < before) gaveBack() else if (!hasRoom(0)) makeRoom(0, null)
    }

    /** Removes an ended connection. */
    fun leave(holder: MemoryHolder) {
        held -= holder.counted
        holder.counted = 0
        waiting.remove(holder)
        gaveBack()
    }

    /** Makes room for more bytes. Returns `false` if there is none; [holder] is woken when bytes are freed. */
    fun room(holder: MemoryHolder, bytes: Long): Boolean {
        if (hasRoom(bytes)) return true
        makeRoom(bytes, holder)
        return hasRoom(bytes).also { if (!it) await(holder) }
    }

    /** Returns `true` if [bytes] fit without closing a connection. */
    fun hasRoom(bytes: Long): Boolean = total + bytes <= limit

    /** Wakes a connection when bytes are freed. */
    fun await(holder: MemoryHolder) {
        waiting.add(holder)
    }

    /**
     * Lends bytes to a handler. Returns `false` if handlers have too many; [holder] is woken when a handler returns
     * some.
     */
    fun lend(holder: MemoryHolder, bytes: Long): Boolean {
        if (bytes > SMALL && lent > 0 && lent + bytes > limit / 2) {
            await(holder)
            return false
        }
        lent += bytes
        return true
    }

    /** Takes back the bytes of an ended handler. */
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

    /** Closes the connections that hold most until [bytes] fit. Closes none if that cannot suffice for [asks]. */
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
            // The closed connection was the one that needs the bytes.
            if (greatest === asks) return
        }
    }

    private companion object {
        /** A connection that holds fewer bytes is not closed: any connection needs this much. */
        const val NEEDED = 128L * 1024

        /** A request up to this length never waits for handlers, so that a busy robot still responds. */
        const val SMALL = 8L * 1024
    }
}
