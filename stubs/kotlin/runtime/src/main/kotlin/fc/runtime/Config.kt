package fc.runtime

import java.util.Calendar
import java.util.concurrent.TimeUnit

/** How to come back after a connection has been lost. */
public class Backoff private constructor(
    internal val first: Long,
    internal val longest: Long,
    internal val attempts: Int,
) {
    /** Waits of 100 ms, then twice as long each time, up to 10 s; for ever. */
    public constructor() : this(100, 10_000, Int.MAX_VALUE)

    /** Wait before the first attempt. */
    public fun first(wait: Long, unit: TimeUnit): Backoff = Backoff(unit.toMillis(wait), longest, attempts)

    /** Longest wait; each is up to a quarter shorter by chance, so that many apps do not come back at once. */
    public fun longest(wait: Long, unit: TimeUnit): Backoff = Backoff(first, unit.toMillis(wait), attempts)

    /** Failed attempts in a row before the connection is given up. */
    public fun attempts(attempts: Int): Backoff = Backoff(first, longest, attempts)
}

/** What a client can be told beforehand. Whatever is not set is the protocol's default; each method gives a changed copy. */
public class ClientConfig private constructor(from: ClientConfig?) {
    /** Three seconds to connect, ten for a frame that does not go on; reconnecting, nothing compressed. */
    public constructor() : this(null)

    internal var host: String? = from?.host
        private set
    internal var commandPort: Int? = from?.commandPort
        private set
    internal var dataPort: Int? = from?.dataPort
        private set
    internal var connectTimeout: Long = from?.connectTimeout ?: 3000
        private set
    internal var callTimeout: Long? = from?.callTimeout
        private set
    internal var reconnect: Backoff? = if (from == null) Backoff() else from.reconnect
        private set
    internal var keepalive: Boolean = from?.keepalive ?: true
        private set
    internal var stallTimeout: Long = from?.stallTimeout ?: 10_000
        private set
    internal var limits: Limits? = from?.limits
        private set
    internal var queuedBytes: Long? = from?.queuedBytes
        private set
    internal var firstId: Long? = from?.firstId
        private set
    internal var gzip: Gzip? = from?.gzip
        private set
    internal var verifyDigest: Boolean = from?.verifyDigest ?: true
        private set
    internal var resync: Boolean = from?.resync ?: false
        private set
    internal var log: Log? = from?.log
        private set

    private inline fun with(change: ClientConfig.() -> Unit): ClientConfig = ClientConfig(this).apply(change)

    /** Name or address of the robot. */
    public fun host(host: String): ClientConfig = with { this.host = host }

    /** Port of commands and reports. */
    public fun commandPort(port: Int): ClientConfig = with { commandPort = port }

    /** Port of streams. */
    public fun dataPort(port: Int): ClientConfig = with { dataPort = port }

    /** How long one attempt to connect may take. */
    public fun connectTimeout(timeout: Long, unit: TimeUnit): ClientConfig = with { connectTimeout = unit.toMillis(timeout) }

    /** How long a call waits for its response, reconnecting included. */
    public fun callTimeout(timeout: Long, unit: TimeUnit): ClientConfig = with { callTimeout = unit.toMillis(timeout) }

    /** How to reconnect, or `null` to give up with the first loss. */
    public fun reconnect(backoff: Backoff?): ClientConfig = with { reconnect = backoff }

    /** Whether TCP asks in silence whether the robot is still there (the default); after how long, the system says. */
    public fun keepalive(keepalive: Boolean): ClientConfig = with { this.keepalive = keepalive }

    /**
     * How long a connection may make no progress, in the middle of a frame or while the robot has something to read, before
     * it is given up. On the command port a frame may take that long in all, and a second more for each 16 KiB of it.
     */
    public fun stallTimeout(timeout: Long, unit: TimeUnit): ClientConfig = with { stallTimeout = unit.toMillis(timeout) }

    /** Bounds of everything that grows with what the robot sends. */
    public fun limits(limits: Limits): ClientConfig = with { this.limits = limits }

    /** Most bytes of reports that wait for the app; as many as the longest body may have, unless set. */
    public fun queuedBytes(bytes: Long): ClientConfig = with { queuedBytes = bytes }

    /** Message id of the first call; the local time of day unless set. */
    public fun firstId(id: Long): ClientConfig = with { firstId = id }

    /** Compresses requests, for robots known to take it. */
    public fun gzip(gzip: Gzip?): ClientConfig = with { this.gzip = gzip }

    /** Whether to verify the digests of what is received (the default). */
    public fun verifyDigest(verify: Boolean): ClientConfig = with { verifyDigest = verify }

    /** Whether to search for the next frame where one should begin and does not, instead of closing (the default). */
    public fun resync(resync: Boolean): ClientConfig = with { this.resync = resync }

    /** Takes the lines that tell what happens to the connection; nobody, unless set. */
    public fun log(log: Log?): ClientConfig = with { this.log = log }

    internal fun limitsOr(protocol: Protocol): Limits = limits ?: protocol.defaults.limits

    internal fun decoder(protocol: Protocol) = Decoder(protocol, limitsOr(protocol), verifyDigest, resync)

    internal fun encoder(protocol: Protocol) = Encoder(protocol, limitsOr(protocol).frameBytes, gzip)
}

/** What a robot can be told beforehand. Whatever is not set is the protocol's default; each method gives a changed copy. */
public class ServerConfig private constructor(from: ServerConfig?) {
    /** All addresses of the machine; five seconds for a header, thirty for an app that has stopped in the middle. */
    public constructor() : this(null)

    internal var address: String = from?.address ?: "0.0.0.0"
        private set
    internal var commandPort: Int? = from?.commandPort
        private set
    internal var dataPort: Int? = from?.dataPort
        private set
    internal var handlerTimeout: Long? = from?.handlerTimeout
        private set
    internal var maxAge: Long? = from?.maxAge
        private set
    internal var limits: Limits? = from?.limits
        private set
    internal var queuedBytes: Long? = from?.queuedBytes
        private set
    internal var connectionsPerAddress: Int = from?.connectionsPerAddress ?: 8
        private set
    internal var abandonedHandlers: Int = from?.abandonedHandlers ?: 64
        private set
    internal var firstId: Long? = from?.firstId
        private set
    internal var gzip: Gzip? = from?.gzip
        private set
    internal var verifyDigest: Boolean = from?.verifyDigest ?: true
        private set
    internal var resync: Boolean = from?.resync ?: false
        private set
    internal var headerTimeout: Long = from?.headerTimeout ?: 5000
        private set
    internal var stallTimeout: Long = from?.stallTimeout ?: 30_000
        private set
    internal var leastRate: Int = from?.leastRate ?: 1024
        private set
    internal var idleTimeout: Long? = from?.idleTimeout
        private set
    internal var keepalive: Boolean = from?.keepalive ?: true
        private set
    internal var allowed: Allowed = from?.allowed ?: Allowed.EVERYBODY
        private set
    internal var log: Log? = from?.log
        private set

    private inline fun with(change: ServerConfig.() -> Unit): ServerConfig = ServerConfig(this).apply(change)

    /** Address to listen at. */
    public fun address(address: String): ServerConfig = with { this.address = address }

    /** Port of commands and reports; 0 for any that is free. */
    public fun commandPort(port: Int): ServerConfig = with { commandPort = port }

    /** Port of streams; 0 for any that is free. */
    public fun dataPort(port: Int): ServerConfig = with { dataPort = port }

    /** How long a handler may take before the app is answered with the result of a timeout. */
    public fun handlerTimeout(timeout: Long, unit: TimeUnit): ServerConfig = with { handlerTimeout = unit.toMillis(timeout) }

    /** Oldest request that is still served, by the time in its envelope; any, unless set. */
    public fun maxAge(age: Long, unit: TimeUnit): ServerConfig = with { maxAge = unit.toMillis(age) }

    /** Bounds of everything that grows with what apps send. */
    public fun limits(limits: Limits): ServerConfig = with { this.limits = limits }

    /** Most bytes of reports that wait for one app or its acknowledgement. The oldest that were not sent give way. */
    public fun queuedBytes(bytes: Long): ServerConfig = with { queuedBytes = bytes }

    /**
     * Most connections from one address, at each port; 8 unless set. One more takes the place of a connection over which
     * nothing has come yet, if there is one.
     */
    public fun connectionsPerAddress(limit: Int): ServerConfig = with { connectionsPerAddress = limit }

    /** How many handlers may run on though nobody waits for their answer any more; 64 unless set, 0 for none. */
    public fun abandonedHandlers(limit: Int): ServerConfig = with { abandonedHandlers = limit }

    /** Message id of the first report on each connection; the local time of day unless set. */
    public fun firstId(id: Long): ServerConfig = with { firstId = id }

    /** Compresses responses and reports, for apps known to take it. */
    public fun gzip(gzip: Gzip?): ServerConfig = with { this.gzip = gzip }

    /** Whether to verify the digests of what is received (the default). */
    public fun verifyDigest(verify: Boolean): ServerConfig = with { verifyDigest = verify }

    /** Whether to search for the next frame where one should begin and does not, instead of closing (the default). */
    public fun resync(resync: Boolean): ServerConfig = with { this.resync = resync }

    /** How long a header may take from its first byte to its last. */
    public fun headerTimeout(timeout: Long, unit: TimeUnit): ServerConfig = with { headerTimeout = unit.toMillis(timeout) }

    /** How long a connection may make no progress, in the middle of a frame or while it has something to read. */
    public fun stallTimeout(timeout: Long, unit: TimeUnit): ServerConfig = with { stallTimeout = unit.toMillis(timeout) }

    /** Fewer bytes per second than this, averaged over the stall timeout, are no progress. */
    public fun leastRate(bytesPerSecond: Int): ServerConfig = with { leastRate = bytesPerSecond }

    /** How long a connection may be silent in between frames before it is closed; for any time, unless set. */
    public fun idleTimeout(timeout: Long, unit: TimeUnit): ServerConfig = with { idleTimeout = unit.toMillis(timeout) }

    /** Whether TCP asks in silence whether the app is still there (the default); after how long, the system says. */
    public fun keepalive(keepalive: Boolean): ServerConfig = with { this.keepalive = keepalive }

    /**
     * Lets apps of this network, such as `10.0.0.0/24`, connect at both ports and call commands with these effects; nobody else,
     * once it is called. Unless it is, everybody may do everything.
     *
     * Of several networks that an address is in, the smallest counts. Who connects from elsewhere is closed at once. A command
     * with another effect is refused with the protocol's error result, and its handler is not run. Reports go to all who are
     * connected. An address is no proof of who sends.
     *
     * @throws IllegalArgumentException if it is not a network
     */
    public fun allow(network: String, vararg effects: Effect): ServerConfig =
        with { allowed = allowed.plus(Network.of(network), effects.toSet()) }

    /** Takes the lines that tell what happens to connections; nobody, unless set. */
    public fun log(log: Log?): ServerConfig = with { this.log = log }

    internal fun limitsOr(protocol: Protocol): Limits = limits ?: protocol.defaults.limits

    internal fun decoder(protocol: Protocol) = Decoder(protocol, limitsOr(protocol), verifyDigest, resync)

    internal fun encoder(protocol: Protocol) = Encoder(protocol, limitsOr(protocol).frameBytes, gzip)
}

/** Where ids begin: the local time of day as the decimal digits `HHmmssSSS`. */
internal fun idOfNow(): Long = Calendar.getInstance().run {
    val hours = get(Calendar.HOUR_OF_DAY) * 100L + get(Calendar.MINUTE)
    (hours * 100 + get(Calendar.SECOND)) * 1000 + get(Calendar.MILLISECOND)
}
