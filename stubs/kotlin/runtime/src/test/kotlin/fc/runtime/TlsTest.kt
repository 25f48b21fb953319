package fc.runtime

import java.io.File
import java.io.InputStream
import java.io.OutputStream
import java.net.InetAddress
import java.net.ServerSocket
import java.net.Socket
import java.security.KeyStore
import java.util.Random
import java.util.concurrent.TimeUnit.MILLISECONDS
import java.util.concurrent.TimeUnit.SECONDS
import javax.net.ssl.KeyManager
import javax.net.ssl.KeyManagerFactory
import javax.net.ssl.SSLContext
import javax.net.ssl.SSLHandshakeException
import javax.net.ssl.TrustManager
import javax.net.ssl.TrustManagerFactory
import kotlin.concurrent.thread
import kotlinx.coroutines.CompletableDeferred
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.async
import kotlinx.coroutines.awaitAll
import kotlinx.coroutines.coroutineScope

/** A key with its certificate for `127.0.0.1`, which is trusted as an authority too. */
private class Identity(name: String) {
    private val store: KeyStore = File.createTempFile("fc-", ".p12").run {
        delete()
        val tool = File(System.getProperty("java.home"), "bin/keytool").path
        val command = listOf(
            tool, "-genkeypair", "-alias", name, "-keyalg", "EC", "-groupname", "secp256r1", "-dname", "CN=$name", "-ext", "san=ip:$LOCAL",
            "-storetype", "PKCS12", "-storepass", PASSWORD, "-keystore", path,
        )
        val process = ProcessBuilder(command).redirectErrorStream(true).start()
        val said = process.inputStream.bufferedReader().readText()
        expect(0, process.waitFor()) { said }
        try {
            KeyStore.getInstance("PKCS12").apply { this@run.inputStream().use { load(it, PASSWORD.toCharArray()) } }
        } finally {
            delete()
        }
    }
    val keys: Array<KeyManager> = KeyManagerFactory.getInstance(KeyManagerFactory.getDefaultAlgorithm())
        .apply { init(store, PASSWORD.toCharArray()) }.keyManagers

    val trust: Array<TrustManager> = TrustManagerFactory.getInstance(TrustManagerFactory.getDefaultAlgorithm()).run {
        val trusted = KeyStore.getInstance("PKCS12")
        trusted.load(null)
        trusted.setCertificateEntry(name, store.getCertificate(name))
        init(trusted)
        trustManagers
    }

    private companion object {
        const val PASSWORD = "password"
    }
}

/** Returns a context with a key that trusts one other side. */
private fun context(own: Identity?, trusted: Identity): SSLContext =
    SSLContext.getInstance("TLS").apply { init(own?.keys, trusted.trust, null) }

/** A link that takes few bytes each time it can write, so that a part of each record waits. */
private class Narrow(private val link: Link) : Link by link {
    private var room = 0

    override fun open(ready: () -> Unit): Unit = link.open {
        room = 500
        ready()
    }

    override fun write(bytes: ByteArray, from: Int, length: Int): Int =
        link.write(bytes, from, minOf(length, room)).also { room -= it }
}

/** Forwards one connection in small pieces of random lengths. */
private class Dribbler(port: Int) : AutoCloseable {
    private val listener = ServerSocket(0, 1, InetAddress.getByName(LOCAL))
    val port: Int get() = listener.localPort

    init {
        thread(isDaemon = true) {
            runCatching {
                val (near, far) = listener.accept() to Socket(LOCAL, port)
                for (socket in listOf(near, far)) socket.tcpNoDelay = true
                for ((from, to) in listOf(near to far, far to near)) {
                    thread(isDaemon = true) { runCatching { pass(from.getInputStream(), to.getOutputStream()) } }
                }
            }
        }
    }

    private fun pass(from: InputStream, to: OutputStream) {
        val random = Random(1)
        val piece = ByteArray(700)
        while (true) {
            val length = from.read(piece, 0, 1 + random.nextInt(piece.size))
            if (length < 0) return to.close()
            to.write(piece, 0, length)
        }
    }

    override fun close(): Unit = listener.close()
}

/** Tests of connections over TLS. */
internal fun tlsTests(tests: Tests) {
    val robotKey = Identity("robot")
    val appKey = Identity("app")
    val ofRobot = context(robotKey, appKey)
    val ofApp = context(appKey, robotKey)
    tests.net("calls, reports and streams") {
        val robot = TestRobot(ServerConfig().tls(ofRobot) { it.needClientAuth = true })
        val app = Connection.connect(Toy, robot.config().tls(ofApp))
        val texts = (0 until 60).map { "$it ".repeat(1 + it * 500) }
        val answers = coroutineScope {
            texts.map { text -> async(Dispatchers.Default) { app.call(Toy.ECHO, Echo.of(text)).text } }.awaitAll()
        }
        expect(texts, answers)
        val reports = app.reports()
        expect(AckOutcome.ACKNOWLEDGED, robot.server.push(Audience.ALL, Toy.MOVED, Moved.of(3))[0].outcome)
        expect(3, (reports.receive()?.message as Moved).metres)
        val data = app.data()
        data.connected()
        val streams = robot.server.streams()
        val bytes = ByteArray(3_000_000).also { Random(2).nextBytes(it) }
        data.send(5, 7, bytes)
        val came = checkNotNull(streams.receive())
        expect(true, bytes.contentEquals(came.frame.data))
        robot.server.sendStream(Audience.one(came.connection), 6, 8, bytes)
        expect(true, bytes.contentEquals(data.receive().data))
        app.close()
        expect("closed_here", app.closed().name)
        robot.server.shutdown(10, SECONDS)
        expect(0L, robot.server.counters.handshakesFailed)
    }
    for (version in listOf("TLSv1.2", "TLSv1.3")) {
        tests.net("$version in pieces of a few bytes") {
            val robot = TestRobot(ServerConfig().tls(ofRobot) { it.enabledProtocols = arrayOf(version) })
            Dribbler(robot.server.commandAddress.port).use { between ->
                val app = Connection.connect(Toy, robot.config().commandPort(between.port).tls(ofApp))
                val text = "x".repeat(60_000)
                repeat(3) { expect(text, app.call(Toy.ECHO, Echo.of(text)).text) }
                app.close()
                app.closed()
            }
            robot.server.shutdown(10, SECONDS)
        }
    }
    tests.net("records that the socket takes in parts") {
        val robot = TestRobot(ServerConfig().tls(ofRobot))
        val loop = NioLoop("narrow")
        val dial = Dial { done ->
            loop.connect(LOCAL, robot.server.commandAddress.port, true) { link, failure -> done(link?.let { Narrow(it) }, failure) }
        }
        val secured = TlsDial(loop, dial) { Tls(ofApp, null).client(LOCAL, 1) }
        val core = ClientCore(Toy, robot.config().callTimeout(10, SECONDS), loop, secured)
        core.begin(isFirstOnly = true)
        val app = Connection(core, secured)
        val text = "x".repeat(60_000)
        expect(text, app.call(Toy.ECHO, Echo.of(text)).text)
        app.close()
        app.closed()
        robot.server.shutdown(10, SECONDS)
        loop.end()
    }
    tests.net("a robot that closes politely has sent everything") {
        val robot = TestRobot(ServerConfig().tls(ofRobot))
        val app = Connection.connect(Toy, robot.config().reconnect(null).tls(ofApp))
        app.call(Toy.ECHO, Echo.of("hello"))
        robot.server.shutdown(10, SECONDS)
        expect("closed_by_robot", app.closed().name)
    }
    for ((name, context, host) in listOf(
        Triple("a robot with a strange certificate", context(appKey, appKey), LOCAL),
        Triple("a robot with another name in its certificate", ofApp, "localhost"),
    )) {
        tests.net("$name is refused, and others are served") {
            val failed = CompletableDeferred<String>()
            val log = Log { _, line -> if ("handshake" in line) failed.complete(line) }
            val robot = TestRobot(ServerConfig().tls(ofRobot).log(log))
            val error = runCatching { Connection.connect(Toy, robot.config().reconnect(null).host(host).tls(context)) }.exceptionOrNull()
            expect(true, (error as ConnectError).cause is javax.net.ssl.SSLHandshakeException) { "$error" }
            val line = failed.await()
            expect(true, line.startsWith("the handshake failed: ")) { line }
            expect(1L, robot.server.counters.handshakesFailed)
            val app = Connection.connect(Toy, robot.config().tls(ofApp))
            expect("hello", app.call(Toy.ECHO, Echo.of("hello")).text)
            app.close()
            robot.server.close()
        }
    }
    tests.net("an app without a certificate is refused") {
        val robot = TestRobot(ServerConfig().tls(ofRobot) { it.needClientAuth = true })
        val app = Connection.connectLazy(Toy, robot.config().reconnect(null).tls(context(null, robotKey)))
        val error = runCatching { app.call(Toy.ECHO, Echo.of("hello")) }.exceptionOrNull()
        expect(true, error is CallError) { "$error" }
        app.closed()
        expect(listOf(1L, 0L), robot.server.counters.run { listOf(handshakesFailed, callsSucceeded) })
        robot.server.close()
    }
    tests.net("an app without TLS is refused at once") {
        val robot = TestRobot(ServerConfig().tls(ofRobot))
        Socket(LOCAL, robot.server.commandAddress.port).use { socket ->
            socket.getOutputStream().write(TestWire.bytes(FrameId(false, 1, 100, 1), "{}".toByteArray()))
            // An alert may come before the end.
            socket.getInputStream().readBytes()
        }
        expect(1L, robot.server.counters.handshakesFailed)
        robot.server.close()
    }
    tests.net("a robot without TLS is refused in time") {
        val robot = TestRobot()
        val config = robot.config().reconnect(null).connectTimeout(10, SECONDS).tls(ofApp)
        val error = runCatching { Connection.connect(Toy, config) }.exceptionOrNull()
        expect(true, error is ConnectError) { "$error" }
        ServerSocket(0, 1, InetAddress.getByName(LOCAL)).use { silent ->
            val quick = config.commandPort(silent.localPort).connectTimeout(30, MILLISECONDS)
            val late = runCatching { Connection.connect(Toy, quick) }.exceptionOrNull() as ConnectError
            expect("connect_timeout", late.loss.name)
        }
        robot.server.close()
    }
    tests.net("a handshake has as much time as a header") {
        val loop = TestLoop()
        val lines = ArrayList<String>()
        val config = ServerConfig().headerTimeout(5, SECONDS).log { _, line -> lines.add(line) }
        val core = ServerCore(Toy, config, loop, Service(), CoroutineScope(Dispatchers.Unconfined))
        val silent = TestLink(loop)
        val engine = ofRobot.createSSLEngine().apply { useClientMode = false }
        expect(true, core.serve(core.secured(silent, engine, null), null))
        loop.advance(4999)
        expect(false, silent.isClosed)
        loop.advance(1)
        expect(true, silent.isClosed)
        expect(true, lines.any { it.startsWith("the handshake failed: the handshake took too long") }) { "$lines" }
    }
}
