package fc.runtime

import java.util.concurrent.TimeUnit

/** Checks of settings and call options. An invalid value throws `IllegalArgumentException` in the call that sets it. */
internal object Settings {
    /** The longest time of a setting, in milliseconds. Sums of a few such times fit into a `Long`. */
    const val LONGEST: Long = Long.MAX_VALUE / 16

    private const val MOST_PORT = 65_535

    /** Most characters of an invalid string in an error. */
    private const val SHOWN = 60

    fun integer(name: String, value: Int, least: Int, most: Int = Int.MAX_VALUE): Int {
        val expected = if (most == Int.MAX_VALUE) "an integer from $least" else "an integer from $least to $most"
        require(value in least..most) { wrong(name, "$value", expected) }
        return value
    }

    fun long(name: String, value: Long, least: Long, most: Long = Long.MAX_VALUE): Long {
        val expected = if (most == Long.MAX_VALUE) "an integer from $least" else "an integer from $least to $most"
        require(value in least..most) { wrong(name, "$value", expected) }
        return value
    }

    /** A port to connect to. */
    fun port(name: String, port: Int): Int = integer(name, port, 1, MOST_PORT)

    /** A port to listen on; 0 for any free port. */
    fun listening(name: String, port: Int): Int = integer(name, port, 0, MOST_PORT)

    /** A time of at least 0, in milliseconds. A positive time below one millisecond becomes one, not 0. */
    fun duration(name: String, time: Long, unit: TimeUnit): Long {
        require(time >= 0) { wrong(name, "$time ${unit.name.lowercase()}", "a time from 0") }
        val whole = unit.toMillis(time)
        return if (whole == 0L && time > 0) 1 else minOf(whole, LONGEST)
    }

    /** A name or address. The system takes an empty one for its own host. */
    fun host(name: String, host: String): String {
        require(host.isNotBlank() && '\u0000' !in host) { wrong(name, "\"${host.take(SHOWN)}\"", "a name or address") }
        return host
    }

    private fun wrong(name: String, found: String, expected: String) = "`$name` is $found, expected $expected"
}
