package fc.bench

import fc.Client
import fc.Fc
import fc.GetStationRequest
import fc.GetStationRequestData
import fc.GetStationResponse
import fc.GetStationResponseData
import fc.PartialRobot
import fc.StationType
import fc.runtime.ClientConfig
import fc.runtime.Context
import fc.runtime.Server
import fc.runtime.ServerConfig
import fc.service
import java.io.DataInputStream
import java.net.InetAddress
import java.net.ServerSocket
import java.net.Socket
import kotlin.concurrent.thread

private const val HOST = "127.0.0.1"
private const val STATION = 1_671_124_918_008
private const val NAME = "gate1"

/** Bytes of the request frame and of the response frame. */
private const val ASKS = 95
private const val ANSWERS = 204

/** Most requests in one write. */
private const val WINDOW = 64

/** A compared peer. It serves at a port, or connects to one. */
internal interface Peer {
    val name: String

    /** `true` if calls are sent in windows. */
    val windows: Boolean

    /** Serves until the process ends. Returns the port. */
    fun serve(): Int

    /** Connects. Returns a function that makes a call, or a window of calls. */
    suspend fun connect(port: Int, window: Int): suspend () -> Unit
}

/** This package. */
private object Package : Peer {
    override val name = "fc"
    override val windows = false

    /** Responds to queries of a station, with a new message for each call. */
    private object Robot : PartialRobot {
        override suspend fun getStation(context: Context, request: GetStationRequest): GetStationResponse = GetStationResponse {
            data(
                GetStationResponseData {
                    stationName(NAME)
                    stationId(request.data.stationId)
                    stationType(StationType.NAVIGATION)
                    x(0.5)
                    y(0.6)
                    yaw(0.2)
                },
            )
        }
    }

    override fun serve(): Int =
        Server.bind(Fc, Robot.service(), ServerConfig().address(HOST).commandPort(0).dataPort(0)).commandAddress.port

    override suspend fun connect(port: Int, window: Int): suspend () -> Unit {
        val client = Client.connect(ClientConfig().host(HOST).commandPort(port))
        return {
            val asked = GetStationRequest { data(GetStationRequestData { stationId(STATION) }) }
            val answer = client.getStation(asked).data
            check(answer.stationId == STATION && answer.stationName == NAME) { "another answer" }
        }
    }
}

private fun sockets(serve: (Socket) -> Unit): Int {
    val listener = ServerSocket(0, 0, InetAddress.getByName(HOST))
    thread(isDaemon = true) {
        while (true) {
            val socket = listener.accept().apply { tcpNoDelay = true }
            thread(isDaemon = true) { socket.use(serve) }
        }
    }
    return listener.localPort
}

private fun socket(port: Int) = Socket(HOST, port).apply { tcpNoDelay = true }

/** The same number of bytes without processing, with a window of requests in one write. */
private object Raw : Peer {
    override val name = "raw"
    override val windows = true

    override fun serve(): Int = sockets { socket ->
        val input = ByteArray(WINDOW * ASKS)
        val answers = ByteArray(WINDOW * ANSWERS)
        var held = 0
        while (true) {
            val count = socket.getInputStream().read(input, 0, input.size - held)
            if (count < 0) break
            held += count
            socket.getOutputStream().write(answers, 0, held / ASKS * ANSWERS)
            held %= ASKS
        }
    }

    override suspend fun connect(port: Int, window: Int): suspend () -> Unit {
        val socket = socket(port)
        val input = DataInputStream(socket.getInputStream())
        val asks = ByteArray(window * ASKS)
        val answers = ByteArray(window * ANSWERS)
        return {
            socket.getOutputStream().write(asks)
            input.readFully(answers)
        }
    }
}

/** The same number of bytes without processing, over blocking sockets with one write and one read per frame. */
private object Blocking : Peer {
    override val name = "blocking"
    override val windows = true

    override fun serve(): Int = sockets { socket ->
        val input = DataInputStream(socket.getInputStream())
        val question = ByteArray(ASKS)
        val answer = ByteArray(ANSWERS)
        while (true) {
            input.readFully(question)
            socket.getOutputStream().write(answer)
        }
    }

    override suspend fun connect(port: Int, window: Int): suspend () -> Unit {
        val socket = socket(port)
        val input = DataInputStream(socket.getInputStream())
        val question = ByteArray(ASKS)
        val answer = ByteArray(ANSWERS)
        return {
            repeat(window) { socket.getOutputStream().write(question) }
            repeat(window) { input.readFully(answer) }
        }
    }
}

/** All compared peers. */
internal val PEERS: List<Peer> = listOf(Raw, Package, Blocking)

/** The reference for calls. Without gRPC for Kotlin, it is the least that blocking sockets need. */
internal val COMPARED: String = Blocking.name
