package fc.runtime

/** The severity of a log line. */
public enum class LogLevel {
    /** An expected event. */
    INFO,

    /** An event that needs attention. */
    WARN,

    /** A bug of the program: an exception of a handler, of a listener, or of the runtime. */
    ERROR,
}

/**
 * Takes the log lines of connections: one per event, with address and reason, but no contents of messages. It runs on
 * the thread of all connections, so it must not block. Its exceptions are ignored.
 */
public fun interface Log {
    /** Takes a line. */
    public fun line(level: LogLevel, line: String)
}

/**
 * The log lines of one side, for its loop alone. Each cause writes at most five lines a minute. The next line has the
 * number of skipped ones.
 */
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
            // Errors of the log cannot be logged. They harm no connection.
        }
    }

    /** Logs an unexpected exception, with [what] as its context. */
    fun failed(what: String, error: Throwable, called: Any? = null, cause: String = what): Unit =
        say(LogLevel.ERROR, cause) { "$what: ${thrown.describe(error, called)}" }

    private companion object {
        const val MINUTE = 60_000L
        const val MOST = 5

        /** Without a log, bugs of the program must still be visible. */
        val ERRORS_ONLY = Log { level, line -> if (level == LogLevel.ERROR) System.err.println(line) }
    }
}
