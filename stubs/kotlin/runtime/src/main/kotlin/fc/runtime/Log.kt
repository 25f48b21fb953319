package fc.runtime

/** How much a line of the log matters. */
public enum class LogLevel {
    /** What is to be expected now and then. */
    INFO,

    /** What somebody should look at. */
    WARN,
}

/**
 * Takes the lines that tell what happens to connections: one for each thing, with address and reason, never with what messages
 * hold. It is called on the thread of all connections, so it must not block.
 */
public fun interface Log {
    /** Takes a line. */
    public fun line(level: LogLevel, line: String)
}

/** The lines of one side: at most five a minute for each cause, the next says how many were left out. */
internal class Lines(private val log: Log?, private val now: () -> Long) {
    private class Cause(var since: Long) {
        var said = 0
        var held = 0L
    }

    private val causes = HashMap<String, Cause>()

    fun say(level: LogLevel, cause: String, line: () -> String) {
        if (log == null) return
        val at = now()
        val known = causes.getOrPut(cause) { Cause(at) }
        if (at - known.since >= MINUTE) {
            known.since = at
            known.said = 0
        }
        if (known.said >= MOST) {
            known.held++
            return
        }
        known.said++
        val held = if (known.held > 0) " (${known.held} more like it were left out)" else ""
        known.held = 0
        log.line(level, line() + held)
    }

    private companion object {
        const val MINUTE = 60_000L
        const val MOST = 5
    }
}
