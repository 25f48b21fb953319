package fc.runtime

/** How much a line of the log matters. */
public enum class LogLevel {
    /** What is to be expected now and then. */
    INFO,

    /** What somebody should look at. */
    WARN,

    /** A fault of the program: an exception of a handler, of a listener, or of the runtime. */
    ERROR,
}

/**
 * Takes the lines that tell what happens to connections: one for each thing, with address and reason, never with what messages
 * hold. It is called on the thread of all connections, so it must not block. Its exceptions are ignored.
 */
public fun interface Log {
    /** Takes a line. */
    public fun line(level: LogLevel, line: String)
}

/** The lines of one side, on its loop alone: at most five a minute for each cause, the next has the number of those left out. */
internal class Lines(log: Log?, protocol: Protocol?, private val now: () -> Long) {
    private class Cause(var since: Long) {
        var said = 0
        var held = 0L
    }

    private val log = log ?: ERRORS_ONLY
    private val thrown = Thrown(protocol)
    private val causes = HashMap<String, Cause>()

    fun say(level: LogLevel, cause: String, line: () -> String) {
        if (log === ERRORS_ONLY && level != LogLevel.ERROR) return
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
        try {
            log.line(level, line() + held)
        } catch (_: Throwable) {
            // A log that fails has nowhere to be logged, and harms no connection.
        }
    }

    /** An exception that neither runtime nor protocol expects: [what] has failed. */
    fun failed(what: String, error: Throwable, called: Any? = null, cause: String = what): Unit =
        say(LogLevel.ERROR, cause) { "$what: ${thrown.describe(error, called)}" }

    private companion object {
        const val MINUTE = 60_000L
        const val MOST = 5

        /** Without a log, faults of the program must not pass unseen. */
        val ERRORS_ONLY = Log { level, line -> if (level == LogLevel.ERROR) System.err.println(line) }
    }
}
