package fc.runtime

/** The cost of useless frames of a connection. While it pays, the robot does not read from it and serves the others. */
internal class Pace {
    private var owed = 0L
    private var at = 0L

    /** The time until which the connection is not read. */
    var until = 0L
        private set

    /** Counts an unusable frame. Returns `true` if the connection must pause. */
    fun unusable(now: Long): Boolean {
        owed = maxOf(0, owed - (now - at)) + UNUSABLE
        at = now
        return rest(owed - UNUSABLE * FREE, now)
    }

    /** Counts decompressed bytes in excess of the compressed ones. Returns `true` if the connection must pause. */
    fun inflated(surplus: Long, now: Long): Boolean = rest(surplus * 1000 / INFLATED, now)

    private fun rest(milliseconds: Long, now: Long): Boolean {
        if (milliseconds <= 0) return false
        until = maxOf(until, after(now, milliseconds))
        return true
    }

    private companion object {
        /** Cost of an unusable frame, in milliseconds. */
        const val UNUSABLE = 1L

        /** Number of free unusable frames. They become free again after their cost in time. */
        const val FREE = 256L

        /** Free rate of decompressed bytes in excess of the compressed ones, in bytes per second. */
        const val INFLATED = 128L * 1024 * 1024
    }
}
