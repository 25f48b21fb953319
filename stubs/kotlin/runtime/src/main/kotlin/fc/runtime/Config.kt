package fc.runtime

import java.util.Calendar
import java.util.concurrent.TimeUnit
import java.util.function.BiConsumer

/** How to come back after a connection has been lost. */
public class Backoff private constructor(
    internal val first: Long,
    internal val longest: Long,
    internal val attempts: Int,
) {
    /** Waits of 100 ms, then twice as long each time, up to 10 s; for ever. */
    public constructor() : this(100, 10_000, Int.MAX_VALUE)

    /** Wait before the first attempt. */
    public fun first(wait: Long, unit: TimeUnit): Backoff =
        Backoff(Settings.duration("Backoff.first", wait, unit), longest, attempts)

    /** Longest wait; each is up to a quarter shorter by chance, so that many apps do not come back at once. */
    public fun longest(wait: Long, unit: TimeUnit): Backoff =
        Backoff(first, Settings.duration("Backoff.longest", wait, unit), attempts)

    /** Failed attempts in a row before the connection is given up. */
    public fun attempts(attempts: Int): Backoff = Backoff(first, longest, Settings.integer("Backoff.attempts", attempts, 0))
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
    public fun host(host: String): ClientConfig = with { this.host = Settings.host("ClientConfig.host", host) }

    /** Port of commands and reports. */
    public fun commandPort(port: Int): ClientConfig = with { commandPort = Settings.port("ClientConfig.commandPort", port) }

    /** Port of streams. */
    public fun dataPort(port: Int): ClientConfig = with { dataPort = Settings.port("ClientConfig.dataPort", port) }

    /** How long one attempt to connect may take. */
    public fun connectTimeout(timeout: Long, unit: TimeUnit): ClientConfig =
        with { connectTimeout = Settings.duration("ClientConfig.connectTimeout", timeout, unit) }

    /** How long a call waits for its response, reconnecting included. */
    public fun callTimeout(timeout: Long, unit: TimeUnit): ClientConfig =
        with { callTimeout = Settings.duration("ClientConfig.callTimeout", timeout, unit) }

    /** How to reconnect, or `null` to give up with the first loss. */
    public fun reconnect(backoff: Backoff?): ClientConfig = with { reconnect = backoff }

    /** Whether TCP asks in silence whether the robot is still there (the default); after how long, the system says. */
    public fun keepalive(keepalive: Boolean): ClientConfig = with { this.keepalive = keepalive }

    /**
     * How long a connection may make no progress, in the middle of a frame or while the robot has something to read, before
     * it is given up. On the command port a frame may take that long in all, and a second more for each 16 KiB of it.
     */
    public fun stallTimeout(timeout: Long, unit: TimeUnit): ClientConfig =
        with { stallTimeout = Settings.duration("ClientConfig.stallTimeout", timeout, unit) }

    /** Bounds of everything that grows with what the robot sends. */
    public fun limits(limits: Limits): ClientConfig = with { this.limits = limits }

    /** Most bytes of reports that wait for the app; as many as the longest body may have, unless set. */
    public fun queuedBytes(bytes: Long): ClientConfig = with { queuedBytes = Settings.long("ClientConfig.queuedBytes", bytes, 0) }

    /** Message id of the first call; the local time of day unless set. */
    public fun firstId(id: Long): ClientConfig = with { firstId = Settings.long("ClientConfig.firstId", id, 0) }

    /** Compresses requests, for robots known to take it. */
    public fun gzip(gzip: Gzip?): ClientConfig = with { this.gzip = gzip }

    /** Whether to verify the digests of what is received (the default). */
    public fun verifyDigest(verify: Boolean): ClientConfig = with { verifyDigest = verify }

    /** Whether to search for the next frame where one should begin and does not, instead of closing (the default). */
    public fun resync(resync: Boolean): ClientConfig = with { this.resync = resync }

    /** Takes the lines that tell what happens to the connection. Unless set, errors are printed to `System.err`. */
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
    internal var memory: Long = from?.memory ?: (256L shl 20)
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
    internal var onHandlerError: BiConsumer<Throwable, Context>? = from?.onHandlerError
        private set

    private inline fun with(change: ServerConfig.() -> Unit): ServerConfig = ServerConfig(this).apply(change)

    /** Address to listen at. */
    public fun address(address: String): ServerConfig = with { this.address = Settings.host("ServerConfig.address", address) }

    /** Port of commands and reports; 0 for any that is free. */
    public fun commandPort(port: Int): ServerConfig = with { commandPort = Settings.listening("ServerConfig.commandPort", port) }

    /** Port of streams; 0 for any that is free. */
    public fun dataPort(port: Int): ServerConfig = with { dataPort = Settings.listening("ServerConfig.dataPort", port) }

    /** How long a handler may take before the app is answered with the result of a timeout. */
    public fun handlerTimeout(timeout: Long, unit: TimeUnit): ServerConfig =
        with { handlerTimeout = Settings.duration("ServerConfig.handlerTimeout", timeout, unit) }

    /** Oldest request that is still served, by the time in its envelope; any, unless set. */
    public fun maxAge(age: Long, unit: TimeUnit): ServerConfig =
        with { maxAge = Settings.duration("ServerConfig.maxAge", age, unit) }

    /** Bounds of everything that grows with what apps send. */
    public fun limits(limits: Limits): ServerConfig = with { this.limits = limits }

    /** Most bytes of reports that wait for one app or its acknowledgement. The oldest that were not sent give way. */
    public fun queuedBytes(bytes: Long): ServerConfig = with { queuedBytes = Settings.long("ServerConfig.queuedBytes", bytes, 0) }

    /**
     * Most connections from one address, at each port; 8 unless set. One more takes the place of a connection over which
     * nothing has come yet, if there is one.
     */
    public fun connectionsPerAddress(limit: Int): ServerConfig =
        with { connectionsPerAddress = Settings.integer("ServerConfig.connectionsPerAddress", limit, 1) }

    /** How many handlers may run on though nobody waits for their answer any more; 64 unless set, 0 for none. */
    public fun abandonedHandlers(limit: Int): ServerConfig =
        with { abandonedHandlers = Settings.integer("ServerConfig.abandonedHandlers", limit, 0) }

    /**
     * Most bytes that apps may make the robot hold, at both ports together; 256 MiB unless set. They count received frames,
     * bodies, requests in handlers, and unsent responses, reports and streams. When they are short, the connection that holds
     * most is closed, and requests wait while handlers hold half. A frame or body may have a quarter. Set less if the heap has
     * not twice as much.
     */
    public fun memory(bytes: Long): ServerConfig = with { memory = Settings.long("ServerConfig.memory", bytes, 1) }

    /** Message id of the first report on each connection; the local time of day unless set. */
    public fun firstId(id: Long): ServerConfig = with { firstId = Settings.long("ServerConfig.firstId", id, 0) }

    /** Compresses responses and reports, for apps known to take it. */
    public fun gzip(gzip: Gzip?): ServerConfig = with { this.gzip = gzip }

    /** Whether to verify the digests of what is received (the default). */
    public fun verifyDigest(verify: Boolean): ServerConfig = with { verifyDigest = verify }

    /** Whether to search for the next frame where one should begin and does not, instead of closing (the default). */
    public fun resync(resync: Boolean): ServerConfig = with { this.resync = resync }

    /** How long a header may take from its first byte to its last. */
    public fun headerTimeout(timeout: Long, unit: TimeUnit): ServerConfig =
        with { headerTimeout = Settings.duration("ServerConfig.headerTimeout", timeout, unit) }

    /** How long a connection may make no progress, in the middle of a frame or while it has something to read. */
    public fun stallTimeout(timeout: Long, unit: TimeUnit): ServerConfig =
        with { stallTimeout = Settings.duration("ServerConfig.stallTimeout", timeout, unit) }

    /** Fewer bytes per second than this, averaged over the stall timeout, are no progress. */
    public fun leastRate(bytesPerSecond: Int): ServerConfig =
        with { leastRate = Settings.integer("ServerConfig.leastRate", bytesPerSecond, 0) }

    /** How long a connection may be silent in between frames before it is closed; for any time, unless set. */
    public fun idleTimeout(timeout: Long, unit: TimeUnit): ServerConfig =
        with { idleTimeout = Settings.duration("ServerConfig.idleTimeout", timeout, unit) }

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

    /** Takes the lines that tell what happens to connections. Unless set, errors are printed to `System.err`. */
    public fun log(log: Log?): ServerConfig = with { this.log = log }

    /**
     * Calls [hook] with each error of a handler and its call. An error is an exception other than a [Refusal], also after the
     * handler timeout, or the reason why the response cannot be sent. It may quote the request; the log has only its class and
     * place. The hook runs on the thread of the handler. An exception of the hook is logged.
     */
    public fun onHandlerError(hook: BiConsumer<Throwable, Context>?): ServerConfig = with { onHandlerError = hook }

    internal fun limitsOr(protocol: Protocol): Limits = limits ?: protocol.defaults.limits

    /** Frames and bodies above a quarter of [memory] are refused: reading one takes up to all of it. */
    internal fun decoder(protocol: Protocol): Decoder {
        val limits = limitsOr(protocol)
        val most = maxOf(1, memory / 4)
        val bounded = limits.frameBytes(minOf(limits.frameBytes, most)).inflatedBytes(minOf(limits.inflatedBytes, most))
        return Decoder(protocol, bounded, verifyDigest, resync)
    }

    internal fun encoder(protocol: Protocol) = Encoder(protocol, limitsOr(protocol).frameBytes, gzip)
}

/** Where ids begin: the local time of day as the decimal digits `HHmmssSSS`. */
internal fun idOfNow(): Long = Calendar.getInstance().run {
    val hours = get(Calendar.HOUR_OF_DAY) * 100L + get(Calendar.MINUTE)
    (hours * 100 + get(Calendar.SECOND)) * 1000 + get(Calendar.MILLISECOND)
}
