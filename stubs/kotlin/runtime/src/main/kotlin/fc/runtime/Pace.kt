package fc.runtime

/**
 * What a connection pays for when its frames make work and cannot be used: for a while nothing is read from it, and the others
 * have the robot to themselves.
 */
internal class Pace {
    private var owed = 0L
    private var at = 0L

    /** When it may be read again. */
    var until = 0L
        private set

    /** A frame could not be used; whether the connection rests for it. */
    fun unusable(now: Long): Boolean {
        owed = maxOf(0, owed - (now - at)) + UNUSABLE
        at = now
        return rest(owed - UNUSABLE * FREE, now)
    }

    /** So many bytes were decompressed beyond those that came; whether the connection rests for it. */
    fun inflated(surplus: Long, now: Long): Boolean = rest(surplus * 1000 / INFLATED, now)

    private fun rest(milliseconds: Long, now: Long): Boolean {
        if (milliseconds <= 0) return false
        until = maxOf(until, after(now, milliseconds))
        return true
    }

    private companion object {
        /** What a frame costs that cannot be used, in milliseconds. */
        const val UNUSABLE = 1L

        /** So many of these are free, and are so again once the time they cost has passed. */
        const val FREE = 256L

        /** How much may be decompressed, in bytes per second, beyond the bytes that came. */
        const val INFLATED = 128L * 1024 * 1024
    }
}
