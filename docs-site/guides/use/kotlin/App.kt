import fc.Client
import fc.runtime.ClientConfig
import kotlinx.coroutines.runBlocking

fun main(arguments: Array<String>): Unit = runBlocking {
    val config = ClientConfig().host("127.0.0.1").commandPort(arguments[0].toInt())
    Client.connect(config).use { client -> println(client.getRobotSn().data.robotSn) }
}
